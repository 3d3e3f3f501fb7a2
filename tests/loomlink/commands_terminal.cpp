#include "commands_case.hpp"

#include <array>
#include <pty.h>
#include <termios.h>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;

namespace {

/// The program at a terminal of its own, with somebody who types.
class AtTerminal {
  public:
    AtTerminal(std::vector<std::string> words, const std::filesystem::path& home) {
        words.insert(words.begin(),
                     (std::filesystem::path(WEAVE_PROGRAM).parent_path() / "loomlink").string());
        std::vector<std::string> environment{"HOME=" + home.string()};
        const auto word_list = pointers(words), variables = pointers(environment);
        m_process = ::forkpty(&m_terminal, nullptr, nullptr, nullptr);
        if (m_process == 0) {
            ::close_range(3, ~0U, 0);  // the sockets of a site in this process
            ::execve(word_list.front(), word_list.data(), variables.data());
            ::_exit(127);
        }
        REQUIRE(m_process > 0);
    }
    ~AtTerminal() {
        if (m_process > 0) ::kill(m_process, SIGKILL), ::waitpid(m_process, nullptr, 0);
        ::close(m_terminal);
    }
    AtTerminal(const AtTerminal&) = delete;
    AtTerminal& operator=(const AtTerminal&) = delete;

    /// Reads the screen until these words are on it, or the program has ended.
    bool shows(const std::string& text) {
        std::array<char, 512> piece{};
        while (screen.find(text) == std::string::npos) {
            const auto got = ::read(m_terminal, piece.data(), piece.size());
            if (got <= 0) return false;
            screen.append(piece.data(), static_cast<std::size_t>(got));
        }
        return true;
    }
    void type(const std::string& text) const {
        REQUIRE(::write(m_terminal, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
    }
    [[nodiscard]] bool echoes() const {
        struct termios now {};
        REQUIRE(::tcgetattr(m_terminal, &now) == 0);
        return (now.c_lflag & ECHO) != 0;
    }
    /// The exit code, or -1 where a signal ended it.
    int wait() {
        shows("\x01 never shown");
        int status = 0;
        ::waitpid(m_process, &status, 0);
        m_process = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

    std::string screen;

  private:
    static std::vector<char*> pointers(std::vector<std::string>& texts) {
        std::vector<char*> list;
        for (auto& text : texts) list.push_back(text.data());
        list.push_back(nullptr);
        return list;
    }

    int m_terminal = -1;
    pid_t m_process = 0;
};

}  // namespace

TEST_CASE("a password that is typed is not shown", "[commands]") {
    CommandMill mill;
    mill.first_joins();
    const std::vector<std::string> login{"login",         mill.url(),         "--name",    "mary",
                                         "--fingerprint", mill.fingerprint(), "--session", mill.at("typed")};
    AtTerminal terminal(login, mill.folder.path);
    REQUIRE(terminal.shows("Password of mary: "));
    CHECK_FALSE(terminal.echoes());
    terminal.type(std::string(CommandMill::password) + "\n");
    CHECK(terminal.wait() == 0);
    CHECK_THAT(terminal.screen, Catch::Contains("mary is signed in"));
    CHECK(terminal.screen.find(CommandMill::password) == std::string::npos);
}

TEST_CASE("Ctrl-C at a password ends the program and leaves the terminal as it was", "[commands]") {
    CommandMill mill;
    mill.first_joins();
    AtTerminal terminal(mill.words_of("mary", {"trust", "publish"}), mill.folder.path);
    REQUIRE(terminal.shows("Password of mary, to sign: "));
    CHECK_FALSE(terminal.echoes());
    terminal.type("half\x03");
    CHECK(terminal.wait() == -1);
    CHECK(terminal.echoes());
}

TEST_CASE("a new password is typed twice, and twice the same", "[commands]") {
    CommandMill mill;
    const auto join = [&](const std::string& again) {
        AtTerminal terminal({"user", "join", mill.introduction.at("invitation").get<std::string>(), "--name",
                             "mary", "--full-name", "Mary", "--fingerprint", mill.fingerprint()},
                            mill.folder.path);
        REQUIRE(terminal.shows("12 or more: "));
        terminal.type("a password of mine\n");
        REQUIRE(terminal.shows("again: "));
        terminal.type(again + "\n");
        return terminal.wait();
    };
    CHECK(join("a password of mime") == 3);
    CHECK(join("a password of mine") == 0);
}
