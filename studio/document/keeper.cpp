#include <studio/document/keeper.hpp>

#include <weave/core/log.hpp>
#include <weave/design/document.hpp>

#include <QStandardPaths>

#include <chrono>
#include <utility>

namespace weave::studio {

using namespace std::chrono_literals;

/// The journal of the thread, and whether it can be written.
class Keeper::Folder {
  public:
    explicit Folder(std::filesystem::path parent) : m_parent(std::move(parent)) {}

    Status begin(const Design& design, const std::string& path, bool is_saved) {
        if (!m_folder) {
            auto made = JournalFolder::make(m_parent);
            if (!made) return std::move(made).error();
            m_folder = std::make_shared<JournalFolder>(std::move(*made));
        }
        return m_folder->begin(design, path, is_saved);
    }
    Status resume(const Recovery& recovery) {
        m_folder = recovery.folder;
        return m_folder->resume(recovery.journal_bytes);
    }
    Status add(const JournalEntry& entry) {
        if (!m_folder) return {};  // told when it could not be made
        m_is_dirty = true;
        return m_folder->add(journal_line(entry));
    }
    Status sync() { return m_folder && std::exchange(m_is_dirty, false) ? m_folder->sync() : Status(); }
    void remove() {
        if (m_folder) m_folder->remove();
        m_folder.reset();
    }
    [[nodiscard]] bool is_dirty() const { return m_is_dirty; }

  private:
    std::filesystem::path m_parent;
    std::shared_ptr<JournalFolder> m_folder;
    bool m_is_dirty = false;
};

namespace {

QString words(const Error& error) {
    return QString::fromStdString(error.text());
}

}  // namespace

Keeper::Keeper(std::filesystem::path recoveries, QObject* parent)
    : QObject(parent), m_folder(std::make_unique<Folder>(std::move(recoveries))) {
    m_thread = std::thread([this] { work(); });
}

Keeper::~Keeper() {
    {
        const std::lock_guard lock(m_mutex);
        m_ends = true;
    }
    m_came.notify_all();
    m_thread.join();
}

void Keeper::ask(std::function<void()> task) {
    {
        const std::lock_guard lock(m_mutex);
        m_tasks.push_back(std::move(task));
    }
    m_came.notify_all();
}

void Keeper::begin(const Design& design, const QString& path, bool is_saved) {
    ask([this, design, path = path.toStdString(), is_saved] {
        if (Status kept = m_folder->begin(design, path, is_saved); !kept) Q_EMIT trouble(words(kept.error()));
    });
}

void Keeper::resume(const Recovery& recovery) {
    ask([this, recovery] {
        if (Status kept = m_folder->resume(recovery); !kept) Q_EMIT trouble(words(kept.error()));
    });
}

void Keeper::record(const JournalEntry& entry) {
    ask([this, entry] {
        if (Status kept = m_folder->add(entry); !kept) Q_EMIT trouble(words(kept.error()));
    });
}

void Keeper::save(const Design& design, const QString& path) {
    ask([this, design, path] {
        if (Status done = save_design(design, path.toStdString()); !done) {
            Q_EMIT not_saved(path, words(done.error()));
            return;
        }
        if (Status kept = m_folder->begin(design, path.toStdString(), true); !kept) Q_EMIT trouble(words(kept.error()));
        Q_EMIT saved(path);
    });
}

void Keeper::discard() {
    ask([this] { m_folder->remove(); });
    flush();
}

void Keeper::flush() {
    std::unique_lock lock(m_mutex);
    m_done.wait(lock, [this] { return m_tasks.empty() && !m_is_busy; });
}

void Keeper::work() {
    auto next_sync = std::chrono::steady_clock::now();
    for (;;) {
        std::function<void()> task;
        {
            std::unique_lock lock(m_mutex);
            const auto has_work = [this] { return m_ends || !m_tasks.empty(); };
            if (m_folder->is_dirty()) {
                m_came.wait_until(lock, next_sync, has_work);
            } else {
                m_came.wait(lock, has_work);
                next_sync = std::chrono::steady_clock::now() + 500ms;
            }
            if (m_tasks.empty() && m_ends) break;
            if (!m_tasks.empty()) {
                task = std::move(m_tasks.front());
                m_tasks.pop_front();
                m_is_busy = true;
            }
        }
        if (task) task();
        if (m_folder->is_dirty() && std::chrono::steady_clock::now() >= next_sync) {
            if (Status kept = m_folder->sync(); !kept) Q_EMIT trouble(words(kept.error()));
            next_sync = std::chrono::steady_clock::now() + 500ms;
        }
        {
            const std::lock_guard lock(m_mutex);
            m_is_busy = false;
        }
        m_done.notify_all();
    }
    if (Status kept = m_folder->sync(); !kept) log(LogLevel::warning, kept.error().text());
}

std::filesystem::path Keeper::usual_folder() {
    return QStandardPaths::writableLocation(QStandardPaths::AppLocalDataLocation).toStdString() + "/unsaved";
}

std::vector<Recovery> Keeper::take_recoveries(const std::filesystem::path& recoveries) {
    std::vector<Recovery> found;
    std::error_code trouble;
    std::vector<std::filesystem::path> folders;
    for (std::filesystem::directory_iterator each(recoveries, trouble), end; !trouble && each != end; each.increment(trouble)) {
        if (each->is_directory(trouble) && each->path().extension() != ".broken") folders.push_back(each->path());
    }
    for (const std::filesystem::path& path : folders) {
        auto folder = JournalFolder::take(path);
        if (!folder) continue;
        auto content = folder->read();
        if (!content) {
            log(LogLevel::warning, "unsaved work could not be read: " + content.error().text());
            std::filesystem::rename(path, path.string() + ".broken", trouble);
            continue;
        }
        ReadJournal read = read_journal(content->journal);
        if (read.entries.empty() && content->base_was_saved) {
            folder->remove();
            continue;
        }
        found.push_back({QString::fromStdString(content->path), std::move(content->base), content->base_was_saved, std::move(read.entries), read.bytes,
                         std::make_shared<JournalFolder>(std::move(*folder))});
    }
    return found;
}

}  // namespace weave::studio
