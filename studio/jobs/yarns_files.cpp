#include <studio/jobs/yarns_files.hpp>

#include <weave/core/file.hpp>
#include <weave/sim/exports.hpp>
#include <weave/sim/yarns_file.hpp>

#include <QMetaObject>
#include <QPointer>

#include <exception>
#include <filesystem>
#include <functional>
#include <mutex>
#include <studio/jobs/leaving_threads.hpp>
#include <utility>

namespace weave::studio {

namespace {

constexpr std::uint64_t most_bytes = std::uint64_t{8} << 30;

std::filesystem::path path_of(const QString& file) {
    return file.toStdString();
}

Result<std::string> bytes_of(const Yarns& yarns, const std::filesystem::path& path) {
    const std::string ending = lower_extension(path);
    if (ending == ".yarns") return write_yarns(yarns);
    if (ending == ".vtp") return write_vtp(yarns);
    if (ending == ".obj") return write_obj(yarns);
    return Error{ErrorCode::usage, "the name must end in .yarns, .vtp or .obj", path.string()};
}

Status write(const Yarns& yarns, const std::filesystem::path& path) {
    WEAVE_TRY(const std::string bytes, bytes_of(yarns, path));
    return write_file(path, bytes);
}

Result<Yarns> read(const std::filesystem::path& path) {
    WEAVE_TRY(const std::string bytes, read_file(path, most_bytes));
    auto yarns = read_yarns(bytes);
    if (!yarns) return std::move(yarns).error().in(path.string());
    return yarns;
}

/// Through this a thread reaches its object as long as there is one.
struct Bridge {
    std::mutex mutex;
    YarnsFiles* files = nullptr;
};

}  // namespace

void YarnsFiles::begin(std::function<std::function<void(YarnsFiles&)>()> work) {
    const auto bridge = std::make_shared<Bridge>();
    bridge->files = this;
    connect(this, &QObject::destroyed, [bridge] {
        const std::lock_guard lock(bridge->mutex);
        bridge->files = nullptr;
    });
    run_apart([bridge, work = std::move(work)] {
        std::function<void(YarnsFiles&)> tell;
        try {
            tell = work();
        } catch (const std::exception& fault) {
            tell = [error = system_fault(fault.what())](YarnsFiles& files) { Q_EMIT files.failed(error); };
        }
        const std::lock_guard lock(bridge->mutex);
        if (bridge->files == nullptr) return;
        QMetaObject::invokeMethod(
            bridge->files,
            [bridge, tell] {
                if (bridge->files != nullptr) tell(*bridge->files);
            },
            Qt::QueuedConnection);
    });
}

void YarnsFiles::write(std::shared_ptr<const Yarns> yarns, const QString& file) {
    begin([yarns = std::move(yarns), file]() -> std::function<void(YarnsFiles&)> {
        const Status done = studio::write(*yarns, path_of(file));
        if (done) return [file](YarnsFiles& files) { Q_EMIT files.written(file); };
        return [error = done.error()](YarnsFiles& files) { Q_EMIT files.failed(error); };
    });
}

void YarnsFiles::read(const QString& file) {
    begin([file, wanted = m_wanted]() -> std::function<void(YarnsFiles&)> {
        auto yarns = studio::read(path_of(file));
        if (!yarns) return [error = yarns.error()](YarnsFiles& files) { Q_EMIT files.failed(error); };
        auto inspection = inspect(*yarns);
        const auto shared = std::make_shared<const Yarns>(std::move(*yarns));
        const auto seen = inspection ? std::make_shared<const Inspection>(std::move(*inspection)) : nullptr;
        return [shared, seen, wanted](YarnsFiles& files) {
            if (wanted == files.m_wanted) Q_EMIT files.was_read(shared, seen);
        };
    });
}

}  // namespace weave::studio
