#pragma once

#include "store_places.hpp"

#include <weave/core/file.hpp>
#include <weave/core/json.hpp>
#include <weave/design/document.hpp>
#include <weave/samples/samples.hpp>

#include <catch2/catch.hpp>

#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <loomlink/commands/running_site.hpp>
#include <loomlink/keys/argon.hpp>
#include <map>
#include <memory>
#include <optional>
#include <spawn.h>
#include <string>
#include <support/temporary_folder.hpp>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace weave::loomlink::testing {

using weave::testing::TemporaryFolder;

/// How a run of the program ended, and all that it said.
struct Ended {
    int code = -1;
    std::string out, err;
    [[nodiscard]] Json json() const {
        INFO(out << err);
        auto read = parse_json(out);
        REQUIRE(read);
        return *std::move(read);
    }
};

/// The program `loomlink` under way: without a terminal, at home in a folder of the test.
class Running {
  public:
    Running(std::vector<std::string> words, const std::filesystem::path& home, const std::string& input = {},
            const std::vector<std::string>& more_environment = {})
        : m_base(home / ("run-" + std::to_string(++runs()))) {
        REQUIRE(write_file(name(".in"), input));
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_addopen(&actions, 0, name(".in").c_str(), O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions, 1, name(".out").c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                         0600);
        posix_spawn_file_actions_addopen(&actions, 2, name(".err").c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                         0600);
        posix_spawn_file_actions_addclosefrom_np(&actions, 3);  // the sockets of a site in this process
        posix_spawnattr_t attributes;
        posix_spawnattr_init(&attributes);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);
        words.insert(words.begin(),
                     (std::filesystem::path(WEAVE_PROGRAM).parent_path() / "loomlink").string());
        std::vector<std::string> environment{"HOME=" + home.string(), "PATH=/usr/bin:/bin"};
        environment.insert(environment.end(), more_environment.begin(), more_environment.end());
        auto word_list = pointers(words), variables = pointers(environment);
        REQUIRE(::posix_spawn(&m_process, word_list.front(), &actions, &attributes, word_list.data(),
                              variables.data()) == 0);
        posix_spawn_file_actions_destroy(&actions);
        posix_spawnattr_destroy(&attributes);
    }
    ~Running() {
        if (m_process > 0) ::kill(m_process, SIGKILL), ::waitpid(m_process, nullptr, 0);
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

    void end(int signal) const { ::kill(m_process, signal); }
    /// What it has answered so far.
    [[nodiscard]] std::string so_far() const { return read_file(name(".out")).value(); }
    [[nodiscard]] std::string told() const { return read_file(name(".err")).value(); }
    [[nodiscard]] bool is_alive() {
        int status = 0;
        if (m_process == 0 || ::waitpid(m_process, &status, WNOHANG) == 0) return m_process != 0;
        m_process = 0;
        return false;
    }
    Ended wait() {
        int status = 0;
        ::waitpid(m_process, &status, 0);
        m_process = 0;
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, so_far(), told()};
    }

  private:
    static int& runs() {
        static int count = 0;
        return count;
    }
    static std::vector<char*> pointers(std::vector<std::string>& texts) {
        std::vector<char*> list;
        for (auto& text : texts) list.push_back(text.data());
        list.push_back(nullptr);
        return list;
    }
    [[nodiscard]] std::filesystem::path name(const char* ending) const { return m_base.string() + ending; }

    std::filesystem::path m_base;
    pid_t m_process = 0;
};

/// A site on a port of its own, over TLS, with people who come to it by commands alone.
struct CommandMill {
    static constexpr const char* password = "warp and weft and warp";

    TemporaryFolder folder;
    Folder stores;
    std::filesystem::path site_folder = folder.path / "site";
    std::unique_ptr<RunningSite> site;
    Json introduction;
    std::uint16_t port = 0;
    bool plain = false;
    std::filesystem::path heads;  ///< a second place for the heads of the log; none: empty
    std::filesystem::path certificate, key;  ///< to serve with; empty: the site's own

    explicit CommandMill(bool without_tls = false) : plain(without_tls) {
        put_private("password", std::string(password) + "\n");
        start();
    }

    [[nodiscard]] Result<std::unique_ptr<RunningSite>> try_start() const {
        ServeConfig config;
        if (stores_are_on_server()) config.store = stores.store("site");
        config.port = port;
        config.plain = plain;
        config.certificate = certificate;
        config.key = key;
        config.hosts = {"127.0.0.1", "localhost"};
        config.heads = heads;
        DeskSettings settings;
        settings.key_cost = settings.login_cost = test_cost();
        return RunningSite::start({site_folder}, config, settings);
    }
    void start() {
        auto started = try_start();
        if (!started) FAIL(started.error().text());
        site = *std::move(started);
        port = site->port();
        introduction = site->introduction().value();
    }
    void stop() { site.reset(); }

    [[nodiscard]] std::string url() const { return introduction.at("url").get<std::string>(); }
    [[nodiscard]] std::string fingerprint() const {
        return introduction.at("certificate_sha256").get<std::string>();
    }
    [[nodiscard]] std::filesystem::path at(const std::string& name) const { return folder.path / name; }
    std::filesystem::path put_private(const std::string& name, const std::string& text) const {
        REQUIRE(write_file(at(name), text));
        REQUIRE(::chmod(at(name).c_str(), 0600) == 0);
        return at(name);
    }

    Ended run(std::vector<std::string> words, const std::string& input = {}) const {
        return Running(std::move(words), folder.path, input).wait();
    }
    /// The words of a command as this person, signed where it has to be.
    [[nodiscard]] std::vector<std::string> words_of(const std::string& who, std::vector<std::string> words,
                                                    bool is_signed = false) const {
        for (const std::string& word : {std::string("--json"), std::string("--session"), at(who).string()})
            words.push_back(word);
        if (is_signed) words.insert(words.end(), {"--password-file", at("password").string()});
        return words;
    }
    Ended as(const std::string& who, std::vector<std::string> words, bool is_signed = false) const {
        return run(words_of(who, std::move(words), is_signed));
    }
    /// The answer of a command that must succeed.
    Json done(const std::string& who, const std::vector<std::string>& words, bool is_signed = false) const {
        const Ended ended = as(who, words, is_signed);
        std::string call;
        for (const std::string& word : words) call += " " + word;
        INFO(who << ":" << call << "\n" << ended.err);
        REQUIRE(ended.code == 0);
        return ended.json();
    }
    Json signs(const std::string& who, std::vector<std::string> words) const {
        words.insert(words.end(), {"--reason", "It is so"});
        return done(who, words, true);
    }

    void join(const std::string& link, const std::string& name) const {
        std::vector<std::string> words{"user", "join", link, "--name", name, "--full-name", "The " + name};
        if (!plain) words.insert(words.end(), {"--fingerprint", fingerprint()});
        done(name, words, true);
    }
    void invite(const std::string& name, const std::vector<std::string>& roles) const {
        std::vector<std::string> words{"user", "invite"};
        words.insert(words.end(), roles.begin(), roles.end());
        join(done("mary", words).at("link").get<std::string>(), name);
    }
    void first_joins() const { join(introduction.at("invitation").get<std::string>(), "mary"); }

    /// The site with its people, the loom `seven` of otto, and a trust document; no simulation is asked for.
    void set_up() const {
        first_joins();
        invite("dora", {"designer", "approver"});
        invite("abel", {"approver"});
        invite("otto", {"operator"});
        invite("emil", {"engineer"});
        done("mary", {"policy", "--simulation", "optional"});
        done("mary", {"loom", "add", "seven", WEAVE_SOURCE_DIR "/db/looms/tc2.json"});
        done("mary", {"loom", "operators", "seven", "otto"});
        done("mary", {"trust", "publish"}, true);
    }

    /// A sample as a file, and that file as the next revision of `cloth`, which is made where it is missing.
    Json save(const std::string& sample) const {
        const auto file = at(sample + ".weave");
        REQUIRE(write_file(file, write_document(find_sample(sample)->make())));
        as("dora", {"design", "make", "cloth"});
        return done("dora", {"save", file, "cloth", "--message", "A " + sample});
    }
    void approve(const std::string& number) const {
        signs("dora", {"submit", "cloth", number});
        signs("abel", {"approve", "cloth", number});
    }
    Json release(const std::string& number, std::vector<std::string> more = {}) const {
        std::vector<std::string> words{"release", "cloth", number, "--loom", "seven"};
        words.insert(words.end(), more.begin(), more.end());
        return signs("abel", words);
    }
    /// A pull of otto's to `loom`, with the state in `state`.
    [[nodiscard]] std::vector<std::string> pull_words(std::vector<std::string> more = {}) const {
        std::vector<std::string> words{"pull", "seven", "--to", at("loom"), "--state", at("state")};
        words.insert(words.end(), more.begin(), more.end());
        return words_of("otto", words);
    }
    [[nodiscard]] std::string trust_fingerprint() const {
        return done("mary", {"trust", "show"}).at("fingerprint").get<std::string>();
    }
};

inline unsigned mode_of(const std::filesystem::path& file) {
    struct stat facts {};
    REQUIRE(::stat(file.c_str(), &facts) == 0);
    return facts.st_mode & 0777;
}

/// The file with one bit of one byte turned.
inline void flip(const std::filesystem::path& file, std::size_t byte) {
    std::string bytes = read_file(file).value();
    REQUIRE(byte < bytes.size());
    bytes[byte] = static_cast<char>(bytes[byte] ^ 1);
    REQUIRE(write_file(file, bytes));
}

}  // namespace weave::loomlink::testing
