#include <loomlink/commands/password_source.hpp>

#include <weave/core/descriptor.hpp>
#include <weave/keys/private_file.hpp>
#include <weave/keys/secret_bytes.hpp>

#include <array>
#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

namespace weave::loomlink {

namespace {

constexpr std::size_t longest_password = 1024;
constexpr std::size_t most_lines_bytes = 4 * (longest_password + 1);

volatile std::sig_atomic_t signal_that_came = 0;

void remember_signal(int signal) {
    signal_that_came = signal;
}

/// While it lives, what is typed is not shown; a signal that ends or stops the program does so only once the
/// terminal is as it was.
class HiddenTyping {
  public:
    explicit HiddenTyping(int terminal) : m_terminal(terminal) {
        signal_that_came = 0;
        // Held back but while waits_for_input() waits: one that came just before it would be slept through.
        sigset_t held;
        sigemptyset(&held);
        for (const int signal : signals) sigaddset(&held, signal);
        sigprocmask(SIG_BLOCK, &held, &m_mask_before);
        struct sigaction remember {};
        remember.sa_handler = remember_signal;
        for (std::size_t k = 0; k < signals.size(); ++k) sigaction(signals[k], &remember, &m_before[k]);
        m_hidden = ::tcgetattr(terminal, &m_shown) == 0;
        struct termios quiet = m_shown;
        quiet.c_lflag &= ~static_cast<tcflag_t>(ECHO);
        m_hidden = m_hidden && ::tcsetattr(terminal, TCSAFLUSH, &quiet) == 0;
    }
    ~HiddenTyping() {
        if (m_hidden) ::tcsetattr(m_terminal, TCSAFLUSH, &m_shown);
        for (std::size_t k = 0; k < signals.size(); ++k) sigaction(signals[k], &m_before[k], nullptr);
        sigprocmask(SIG_SETMASK, &m_mask_before, nullptr);
        if (signal_that_came != 0) std::raise(signal_that_came);
    }
    HiddenTyping(const HiddenTyping&) = delete;
    HiddenTyping& operator=(const HiddenTyping&) = delete;
    [[nodiscard]] bool is_hidden() const { return m_hidden; }
    /// Until there is something to read; false where a signal came instead.
    [[nodiscard]] bool waits_for_input() const {
        struct pollfd there {
            m_terminal, POLLIN, 0
        };
        return ::ppoll(&there, 1, nullptr, &m_mask_before) == 1;
    }

  private:
    static constexpr std::array signals{SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP};
    int m_terminal;
    bool m_hidden = false;
    struct termios m_shown {};
    std::array<struct sigaction, 5> m_before{};
    sigset_t m_mask_before{};
};

Error no_terminal() {
    return {ErrorCode::usage, "there is no terminal to type a password at; say --password-file", ""};
}

Status check_length(const std::string& password, const std::string& where) {
    if (password.empty()) return bad_input("holds no password where one is needed", where);
    if (password.size() > longest_password)
        return bad_input("holds a line of more than 1,024 bytes, which is no password", where);
    return {};
}

Result<std::string> typed(const std::string& prompt) {
    const Descriptor terminal(::open("/dev/tty", O_RDWR | O_NOCTTY | O_CLOEXEC));
    if (terminal.number() < 0) return no_terminal();
    const HiddenTyping hidden(terminal.number());
    if (!hidden.is_hidden()) return no_terminal();
    WEAVE_CHECK_OK(write_all(terminal, prompt + ": ", "/dev/tty"));
    std::string line;
    line.reserve(most_lines_bytes);  // so that no copy of it is left behind
    char c = 0;
    while (line.size() <= longest_password && hidden.waits_for_input() &&
           ::read(terminal.number(), &c, 1) == 1 && c != '\n')
        line += c;
    WEAVE_CHECK_OK(write_all(terminal, "\n", "/dev/tty"));
    if (signal_that_came != 0) return Error{ErrorCode::refused, "interrupted", ""};
    WEAVE_CHECK_OK(check_length(line, "password"));
    return line;
}

Result<std::string> read_lines(const std::string& file) {
    const bool standard_input = file == "-";
    const Descriptor opened(standard_input ? -1 : ::open(file.c_str(), O_RDONLY | O_CLOEXEC));
    const int number = standard_input ? STDIN_FILENO : opened.number();
    struct stat facts {};
    if (number < 0 || ::fstat(number, &facts) != 0)
        return bad_input(std::string("cannot open: ") + std::strerror(errno), file);
    if (!standard_input && S_ISREG(facts.st_mode)) WEAVE_CHECK_OK(check_private_file(file));
    std::string bytes;
    bytes.reserve(most_lines_bytes + 1);
    while (bytes.size() <= most_lines_bytes) {
        std::array<char, longest_password> piece{};
        const ssize_t got = ::read(number, piece.data(), piece.size());
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return file_fault(file, "read");
        if (got == 0) return bytes;
        bytes.append(piece.data(), static_cast<std::size_t>(got));
    }
    wipe(bytes);
    return bad_input("holds more than passwords, one a line", file);
}

}  // namespace

PasswordSource::~PasswordSource() {
    if (m_rest) wipe(*m_rest);
}

Result<std::string> PasswordSource::ask(const std::string& prompt) {
    return m_file.empty() ? typed(prompt) : next_line();
}

Result<std::string> PasswordSource::ask_new(const std::string& prompt) {
    WEAVE_TRY(std::string first, ask(prompt));
    if (!m_file.empty()) return first;
    WEAVE_TRY(std::string again, ask(prompt + " again"));
    const bool same = equal_secrets(first, again);
    wipe(again);
    if (same) return first;
    wipe(first);
    return bad_input("the two passwords differ", "password");
}

Result<std::string> PasswordSource::next_line() {
    if (!m_rest) {
        WEAVE_TRY(m_rest, read_lines(m_file));
    }
    const std::size_t end = m_rest->find('\n');
    std::string line = m_rest->substr(0, end);
    std::string rest = end == std::string::npos ? std::string() : m_rest->substr(end + 1);
    wipe(*m_rest);
    m_rest = std::move(rest);
    WEAVE_CHECK_OK(check_length(line, m_file));
    return line;
}

}  // namespace weave::loomlink
