#include <loomlink/commands/head_keeper.hpp>

#include <weave/core/descriptor.hpp>
#include <weave/core/file.hpp>
#include <weave/core/log.hpp>

#include <fcntl.h>
#include <unistd.h>
#include <utility>

namespace weave::loomlink {

namespace {

/// Adds a line, and answers once it is on the disk.
Status add_line(const std::filesystem::path& file, const std::string& line) {
    const Descriptor opened(::open(file.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0644));
    if (opened.number() < 0) return file_fault(file, "open");
    WEAVE_CHECK_OK(write_all(opened, line, file));
    return ::fsync(opened.number()) == 0 ? Status() : Status(file_fault(file, "flush"));
}

}  // namespace

Result<std::unique_ptr<HeadKeeper>> HeadKeeper::start(std::filesystem::path file,
                                                      std::function<Result<SignedTreeHead>()> newest,
                                                      std::chrono::milliseconds pause) {
    WEAVE_CHECK_OK(add_line(file, ""));
    return std::unique_ptr<HeadKeeper>(new HeadKeeper(std::move(file), std::move(newest), pause));
}

HeadKeeper::HeadKeeper(std::filesystem::path file, std::function<Result<SignedTreeHead>()> newest,
                       std::chrono::milliseconds pause)
    : m_file(std::move(file)), m_newest(std::move(newest)), m_pause(pause) {
    m_thread = std::jthread([this](const std::stop_token& stop) { work(stop); });
}

HeadKeeper::~HeadKeeper() {
    m_thread.request_stop();
    m_thread.join();
    keep_newest();
}

Status HeadKeeper::status() const {
    const std::lock_guard lock(m_mutex);
    return m_status;
}

void HeadKeeper::work(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
        std::unique_lock lock(m_mutex);
        m_wake.wait_for(lock, stop, m_pause, [] { return false; });
        lock.unlock();
        if (!stop.stop_requested()) keep_newest();
    }
}

void HeadKeeper::keep_newest() {
    const auto head = m_newest();
    Status outcome = head ? Status() : Status(head.error());
    if (head && head->head.size > m_kept) {
        outcome = add_line(m_file, signed_head_bytes(*head) + "\n");
        if (outcome) m_kept = head->head.size;
    }
    const std::lock_guard lock(m_mutex);
    if (!outcome && m_status)
        log(LogLevel::warning, "a head of the log could not be kept elsewhere: " + outcome.error().text());
    m_status = std::move(outcome);
}

Result<SignedTreeHead> load_retained_head(const std::filesystem::path& file) {
    constexpr std::uint64_t most_bytes = std::uint64_t{64} << 20;
    WEAVE_TRY(std::string text, read_file(file, most_bytes));
    if (const std::size_t end = text.rfind('\n'); end != std::string::npos) {
        text.resize(end);
        text.erase(0, text.rfind('\n') + 1);
    }
    auto head = parse_signed_head(text);
    if (!head) return std::move(head).error().in(file.string());
    return head;
}

}  // namespace weave::loomlink
