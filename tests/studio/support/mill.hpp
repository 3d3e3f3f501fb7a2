#pragma once

#include <weave/core/file.hpp>
#include <weave/core/json.hpp>

#include <catch2/catch.hpp>

#include <csignal>
#include <filesystem>
#include <memory>
#include <string>
#include <support/temporary_folder.hpp>
#include <support/program.hpp>
#include <sys/stat.h>
#include <utility>
#include <vector>

namespace weave::studio::test {

/// A mill of the test's own: the real program `loomlink` serves an empty folder on a free port, and people
/// come to it by its commands. Mary administers, Dora designs, Abel approves; no simulation is asked for.
class Mill {
  public:
    static constexpr const char* password = "warp and weft and warp";

    Mill() {
        put_private("password", std::string(password) + "\n");
        start();
        join(m_introduction.at("invitation"), "mary");
        invite("dora", "designer");
        invite("abel", "approver");
        as("mary", {"policy", "--simulation", "optional"});
    }

    void start() {
        m_server = std::make_unique<Server>(
            "loomlink",
            std::vector<std::string>{"serve", at("site"), "--host", "localhost", "--port", m_port, "--json"},
            at("told"));
        m_introduction = parse_json(m_server->line()).value();
        const std::string url = m_introduction.at("url");
        m_port = url.substr(url.rfind(':') + 1);
        while (m_port.ends_with('/')) m_port.pop_back();
    }
    /// The server ends; start() brings it back at the same place.
    void stop() {
        m_server->end(SIGTERM);
        m_server->exit_code();
        m_server.reset();
    }

    /// The server stands still, and takes connections all the same, as one does that is overloaded.
    void suspend() const { m_server->suspend(); }
    void resume() const { m_server->end(SIGCONT); }

    [[nodiscard]] std::string origin() const { return "https://localhost:" + m_port; }
    [[nodiscard]] std::string site() const { return m_introduction.at("site"); }
    /// The file of a key that an enrolled machine signs evidence with.
    std::string enrol_machine() const {
        const std::string code = as("mary", {"signer", "invite", "box"}).at("code");
        as("machine", {"signer", "enrol", code, "--server", origin(), "--fingerprint", fingerprint(),
                       "--key-file", at("evidence.key")});
        return at("evidence.key");
    }
    [[nodiscard]] std::string fingerprint() const { return m_introduction.at("certificate_sha256"); }
    [[nodiscard]] std::filesystem::path session_of(const std::string& who) const {
        return at(who + ".session");
    }
    [[nodiscard]] std::string at(const std::string& name) const { return (m_folder.path / name).string(); }

    /// What a command of this person's answers; it must succeed.
    Json as(const std::string& who, std::vector<std::string> words, bool is_signed = false) const {
        words.insert(words.end(), {"--json", "--session", session_of(who)});
        if (is_signed) words.insert(words.end(), {"--password-file", at("password")});
        std::string call = who + ":";
        for (const std::string& word : words) call += " " + word;
        Server run("loomlink", std::move(words), at("told"));
        const std::string answer = run.rest();
        const int code = run.exit_code();
        INFO(call << "\n" << answer << read_file(at("told")).value());
        REQUIRE(code == 0);
        return parse_json(answer).value();
    }
    Json signs(const std::string& who, std::vector<std::string> words, const std::string& reason) const {
        words.insert(words.end(), {"--reason", reason});
        return as(who, std::move(words), true);
    }

  private:
    using Server = weave::testing::Program;

    void join(const std::string& link, const std::string& name) const {
        as(name,
           {"user", "join", link, "--name", name, "--full-name", "The " + name, "--fingerprint",
            fingerprint()},
           true);
    }
    void invite(const std::string& name, const std::string& role) const {
        join(as("mary", {"user", "invite", role}).at("link"), name);
    }
    void put_private(const std::string& name, const std::string& text) const {
        REQUIRE(write_file(at(name), text));
        REQUIRE(::chmod(at(name).c_str(), 0600) == 0);
    }

    weave::testing::TemporaryFolder m_folder;
    std::unique_ptr<Server> m_server;
    Json m_introduction;
    std::string m_port = "0";
};

}  // namespace weave::studio::test
