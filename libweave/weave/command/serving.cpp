#include <weave/command/serving.hpp>

#include <weave/core/log.hpp>
#include <weave/core/text.hpp>

#include <array>
#include <cerrno>
#include <ctime>
#include <fcntl.h>
#include <iostream>
#include <string_view>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace weave {

namespace {

/// For the system's reason (errno).
Error cannot_make(const std::filesystem::path& folder) {
    if (errno != ENOENT) return file_fault(folder, "make the folder");
    return bad_input("cannot be made, since the folder above it is missing; make that first, or mend the name", folder.string());
}

}  // namespace

void log_to_stderr() {
    set_log_sink([](LogLevel level, std::string_view message) {
        if (level == LogLevel::debug) return;
        const std::time_t now = std::time(nullptr);
        std::tm parts{};
        std::array<char, 24> text{};
        ::gmtime_r(&now, &parts);
        std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
        const char* const word = level == LogLevel::warning ? " warning: " : " ";
        std::cerr << text.data() + (word + on_one_line(message)) + '\n';
    });
}

EndingSignals::EndingSignals() {
    sigemptyset(&m_signals);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&m_signals, signal);
    pthread_sigmask(SIG_BLOCK, &m_signals, nullptr);
}

void EndingSignals::wait() const {
    int signal = 0;
    sigwait(&m_signals, &signal);
}

bool EndingSignals::wait(std::chrono::milliseconds most) const {
    const timespec time{most.count() / 1000, static_cast<long>(most.count() % 1000 * 1'000'000)};
    return sigtimedwait(&m_signals, nullptr, &time) > 0;
}

Result<FolderLock> FolderLock::take(const std::filesystem::path& folder, const std::string& who) {
    const std::filesystem::path path = folder / ".lock";
    Descriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
    if (file.number() < 0) return file_fault(path, "make the lock");
    if (::flock(file.number(), LOCK_EX | LOCK_NB) == 0) return FolderLock(std::move(file));
    if (errno != EWOULDBLOCK) return file_fault(path, "take the lock");
    return Error{ErrorCode::refused, "is in use by another " + who, folder.string()};
}

Status make_service_folder(const std::filesystem::path& folder) {
    if (::mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST) return {};
    return cannot_make(folder);
}

Status check_service_folder(const std::filesystem::path& folder) {
    std::error_code trouble;
    std::filesystem::path whole = std::filesystem::absolute(folder, trouble);
    if (!whole.has_filename()) whole = whole.parent_path();  // `box/` is `box`
    if (std::filesystem::exists(whole, trouble) && !std::filesystem::is_directory(whole, trouble)) return system_fault("is a file, not a folder", folder.string());
    if (std::filesystem::exists(whole, trouble) || ::access(whole.parent_path().c_str(), W_OK | X_OK) == 0) return {};
    return cannot_make(folder);
}

}  // namespace weave
