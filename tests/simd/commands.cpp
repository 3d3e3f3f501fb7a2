// The program as its owner runs it: configuration, folders, tokens, what it tells, and how it ends.

#include "people.hpp"

#include <weave/core/file.hpp>
#include <weave/net/certificate.hpp>

#include <array>
#include <poll.h>
#include <pty.h>
#include <simd/commands/config.hpp>
#include <simd/commands/status_table.hpp>
#include <sstream>
#include <sys/stat.h>
#include <termios.h>

using namespace weave;
using namespace weave::simd;
using namespace weave::simd::testing;

namespace {

struct Ran {
    int code = -1;
    std::string out, err;
};

/// Runs the program to its end.
Ran run(const std::vector<std::string>& words) {
    const weave::testing::TemporaryFolder folder;
    const std::string told = (folder.path / "told").string();
    weave::testing::Program program("simd", words, told);
    Ran ran;
    ran.out = program.rest();
    ran.code = program.exit_code();
    if (auto text = read_file(told)) ran.err = std::move(*text);
    return ran;
}

/// The program at a terminal of its own.
class AtTerminal {
  public:
    AtTerminal(const std::vector<std::string>& words, unsigned short columns, unsigned short lines) {
        std::vector<std::string> all{(std::filesystem::path(WEAVE_PROGRAM).parent_path() / "simd").string()};
        all.insert(all.end(), words.begin(), words.end());
        std::vector<char*> pointers;
        for (std::string& word : all) pointers.push_back(word.data());
        pointers.push_back(nullptr);
        winsize size{lines, columns, 0, 0};
        m_process = ::forkpty(&m_terminal, nullptr, nullptr, &size);
        if (m_process == 0) {
            ::close_range(3, ~0U, 0);
            ::execv(pointers.front(), pointers.data());
            ::_exit(127);
        }
        REQUIRE(m_process > 0);
        REQUIRE(::tcgetattr(m_terminal, &m_before) == 0);
    }
    ~AtTerminal() {
        if (m_process > 0) ::kill(m_process, SIGKILL), ::waitpid(m_process, nullptr, 0);
        ::close(m_terminal);
    }
    AtTerminal(const AtTerminal&) = delete;
    AtTerminal& operator=(const AtTerminal&) = delete;

    bool shows(const std::string& text) {
        while (screen.find(text) == std::string::npos) {
            if (!read_more()) return false;
        }
        return true;
    }
    void type(const std::string& text) const { REQUIRE(::write(m_terminal, text.data(), text.size()) == static_cast<ssize_t>(text.size())); }
    int wait() {
        while (read_more()) {}
        int status = 0;
        ::waitpid(m_process, &status, 0);
        m_process = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    [[nodiscard]] bool is_as_before() const {
        termios now{};
        REQUIRE(::tcgetattr(m_terminal, &now) == 0);
        return now.c_lflag == m_before.c_lflag && now.c_iflag == m_before.c_iflag && now.c_oflag == m_before.c_oflag;
    }

    std::string screen;

  private:
    bool read_more() {
        pollfd wait{m_terminal, POLLIN, 0};
        if (::poll(&wait, 1, 60'000) <= 0) return false;
        std::array<char, 4096> piece{};
        const ssize_t got = ::read(m_terminal, piece.data(), piece.size());
        if (got <= 0) return false;
        screen.append(piece.data(), static_cast<std::size_t>(got));
        return true;
    }
    int m_terminal = -1;
    pid_t m_process = 0;
    termios m_before{};
};

std::size_t widest_line(const std::string& text) {
    std::istringstream lines(text);
    std::size_t widest = 0;
    for (std::string line; std::getline(lines, line);) {
        std::size_t width = 0;
        for (const char c : line) width += (static_cast<unsigned char>(c) & 0xc0U) != 0x80U && c != '\r' ? 1 : 0;
        widest = std::max(widest, width);
    }
    return widest;
}

}  // namespace

TEST_CASE("a configuration is read, and what it leaves out stays as it is") {
    const auto config = parse_config(R"({"address":"0.0.0.0","port":9000,"hosts":["box"],"threads":3,"memory_mib":100,"expire_seconds":60,"workers":2,"backend":"cpu"})");
    REQUIRE(config);
    CHECK(config->backend == "cpu");
    CHECK(config->address == "0.0.0.0");
    CHECK(config->port == 9000);
    CHECK(config->hosts == std::vector<std::string>{"box"});
    CHECK(threads_of(*config) == 3);
    CHECK(memory_of(*config) == std::uint64_t{100} << 20);
    const auto plain = parse_config("{}");
    REQUIRE(plain);
    CHECK(plain->port == 8444);
    CHECK(plain->backend == "auto");
    CHECK(threads_of(*plain) >= 1);
    CHECK(memory_of(*plain) > std::uint64_t{64} << 20);
}

TEST_CASE("a configuration that is wrong is refused at its place, by the program too") {
    const weave::testing::TemporaryFolder folder;
    const std::string file = (folder.path / "simd.json").string(), key(64, 'f');
    std::vector<std::pair<std::string, std::string>> wrong{
        {"", ""}, {"[]", ""}, {"{", ""}, {R"({"prot":1})", "prot"}, {R"({"port":1,"port":2})", ""}, {R"({"hosts":"x"})", "hosts"}, {R"({"hosts":["x",1]})", "hosts[1]"},
        {R"({"access_keys":[1]})", "access_keys[0]"}, {R"({"site":"m","access_keys":["xx"]})", "access_keys[0]"}, {R"({"site":"m","access_keys":[")" + key + R"("]})", "access_keys[0]"},
        {R"({"certificate":"x.pem"})", "key"}, {R"({"key":"x.key"})", "certificate"}, {R"({"plain":true,"certificate":"x","key":"y"})", "plain"},
        {R"({"plain":true,"address":"0.0.0.0"})", "address"}, {R"({"site":"mill"})", "site"}, {R"({"memory_mib":40})", "memory_mib"}, {R"({"backend":"abacus"})", "backend"}};
    for (const char* member : {"address", "certificate", "key", "unix_socket", "site", "evidence_key", "backend"}) {
        wrong.emplace_back("{\"" + std::string(member) + "\":1}", member);
        wrong.emplace_back("{\"" + std::string(member) + "\":\"" + std::string(5000, 'x') + "\"}", member);
    }
    for (const char* member : {"port", "workers", "threads", "memory_mib", "sessions", "sessions_per_person", "jobs_at_once", "jobs_per_person", "expire_seconds", "stall_seconds"}) {
        for (const char* value : {"\"1\"", "-1", "1.5", "9007199254740992", "null", "[]"}) wrong.emplace_back("{\"" + std::string(member) + "\":" + value + "}", member);
    }
    for (const char* member : {"workers", "sessions", "sessions_per_person", "jobs_at_once", "jobs_per_person", "expire_seconds", "stall_seconds"})
        wrong.emplace_back("{\"" + std::string(member) + "\":0}", member);
    wrong.emplace_back(R"({"plain":1})", "plain");
    for (const auto& [text, where] : wrong) {
        INFO(text.substr(0, 100));
        const auto config = parse_config(text);
        REQUIRE_FALSE(config);
        CHECK(config.error().code == ErrorCode::bad_input);
        if (!where.empty()) CHECK(config.error().where == where);
    }
    for (const std::size_t k : {std::size_t{3}, wrong.size() - 1}) {
        REQUIRE(write_file(file, wrong[k].first));
        const Ran ran = run({"serve", "--config", file, "--check-config", "--json"});
        CHECK(ran.code == 3);
        CHECK(parse_json(ran.out).value().at("error").at("where") == file + ": " + wrong[k].second);
    }
    for (const char* text : {R"({"port":0})", R"({"address":"","memory_mib":100})"}) {
        REQUIRE(write_file(file, text));
        CHECK(run({"serve", "--config", file, "--check-config"}).code == 0);
    }
}

TEST_CASE("places that are missing or open to others are found before anything is served") {
    const weave::testing::TemporaryFolder folder;
    const std::string file = (folder.path / "simd.json").string();
    const net::TlsFiles tls{folder.path / "tls.pem", folder.path / "tls.key"};
    const auto check = [&](const std::string& config, const std::string& where) {
        REQUIRE(write_file(file, config));
        const Ran ran = run({"serve", "--config", file, "--check-config", "--json"});
        INFO(config << ran.out << ran.err);
        CHECK(ran.code > 2);
        CHECK_THAT(parse_json(ran.out).value().at("error").at("where").get<std::string>(), Catch::StartsWith(file + ": " + where));
        CHECK(run({"serve", (folder.path / "box").string(), "--config", file}).code == ran.code);
        CHECK_FALSE(std::filesystem::exists(folder.path / "box"));
    };
    const std::string both = R"({"port":0,"certificate":"tls.pem","key":"tls.key"})";
    check(both, "certificate: " + tls.certificate.string());
    REQUIRE(net::make_certificate(tls, {"localhost"}));
    REQUIRE(run({"serve", "--config", file, "--check-config"}).code == 0);
    std::filesystem::permissions(tls.key, std::filesystem::perms(0644));
    check(both, "key: " + tls.key.string());
    REQUIRE(write_file(tls.certificate, "no certificate"));
    check(both, "certificate");
    check(R"({"port":0,"evidence_key":"no.key"})", "evidence_key: " + (folder.path / "no.key").string());
    check(R"({"hosts":["a b"]})", "hosts[0]");
    check(R"({"port":0,"unix_socket":"none/simd.sock"})", "unix_socket: " + (folder.path / "none/simd.sock").string());
    check(R"({"port":0,"unix_socket":")" + std::string(108, 'x') + R"("})", "unix_socket");
    const Ran option = run({"serve", "--check-config", "--address", "", "--socket", (folder.path / "none" / "s").string(), "--json"});
    CHECK_THAT(parse_json(option.out).value().at("error").at("where").get<std::string>(), Catch::StartsWith("--socket: "));
    CHECK(run({"serve", "--config", (folder.path / "none").string(), "--check-config"}).code != 0);
}

TEST_CASE("a check says that address or socket is taken, and that its folder cannot be made") {
    const Box box(Json{{"address", "127.0.0.1"}, {"port", 0}, {"plain", true}});
    const std::string url = box.introduction.at("url"), place = url.substr(url.find("//") + 2), port = place.substr(place.find(':') + 1);
    const auto refused = [](const std::vector<std::string>& words, int code, const std::string& where) {
        std::vector<std::string> all{"serve", "--check-config", "--json"};
        all.insert(all.end(), words.begin(), words.end());
        const Ran ran = run(all);
        INFO(ran.out << ran.err);
        CHECK(ran.code == code);
        CHECK(parse_json(ran.out).value().at("error").at("where") == where);
    };
    const std::string other = (box.folder().parent_path() / "other").string(), far = (box.folder() / "no" / "such").string();
    refused({other, "--port", port}, 5, "--port: " + place);
    refused({box.folder().string(), "--address", ""}, 4, "unix_socket: " + (box.folder() / "simd.sock").string());
    refused({far, "--address", ""}, 3, far);
    CHECK(run({"serve", other, "--check-config", "--address", ""}).code == 0);
    CHECK_FALSE(std::filesystem::exists(other));
    CHECK(box.status().at("sessions").empty());
}

TEST_CASE("a folder is served by one daemon, and only where it can be written") {
    const Box box;
    const Ran second = run({"serve", box.folder().string(), "--address", "", "--json"});
    CHECK(second.code == 4);
    CHECK(parse_json(second.out).value().at("error").at("kind") == "refused");
    const weave::testing::TemporaryFolder folder;
    CHECK(run({"serve", (folder.path / "no" / "such").string(), "--address", ""}).code != 0);
    REQUIRE(write_file(folder.path / "file", "x"));
    CHECK(run({"serve", (folder.path / "file").string(), "--address", ""}).code != 0);
    if (::geteuid() != 0) {  // to whom nothing is read-only
        std::filesystem::create_directory(folder.path / "closed");
        std::filesystem::permissions(folder.path / "closed", std::filesystem::perms(0500));
        CHECK(run({"serve", (folder.path / "closed").string(), "--address", ""}).code == 5);
        std::filesystem::permissions(folder.path / "closed", std::filesystem::perms(0700));
    }
    CHECK(box.status().at("sessions").empty());
}

TEST_CASE("tokens are given, listed and taken away, and nobody but their owner can read the file") {
    const weave::testing::TemporaryFolder folder;
    const std::string box = (folder.path / "box").string();
    CHECK(run({"token", "list", box}).out == "nobody has a token\n");
    const Ran added = run({"token", "add", box, "dora", "--json"});
    REQUIRE(added.code == 0);
    const std::string token = parse_json(added.out).value().at("token");
    const std::filesystem::path file = std::filesystem::path(box) / "tokens";
    CHECK((std::filesystem::status(file).permissions() & std::filesystem::perms(0077)) == std::filesystem::perms::none);
    CHECK(read_file(file).value().find(token) == std::string::npos);
    CHECK(run({"token", "add", box, "abel"}).code == 0);
    const Ran listed = run({"token", "list", box, "--json"});
    CHECK(parse_json(listed.out).value().at("people").size() == 2);
    CHECK(listed.out.find(token) == std::string::npos);
    for (const char* name : {"", "local", "Dora", "a b", "dora\n", "../x", "ä"}) {
        INFO(name);
        CHECK(run({"token", "add", box, name}).code == 2);
    }
    CHECK(run({"token", "add", box, std::string(101, 'a')}).code == 2);
    CHECK(run({"token", "remove", box, "nobody"}).code == 4);
    CHECK(run({"token", "remove", box, "dora"}).code == 0);
    CHECK(parse_json(run({"token", "list", box, "--json"}).out).value().at("people") == Json{"abel"});
}

TEST_CASE("what a daemon does is told to people and to programs, near and far") {
    const People people;
    Followed session(people.follower("dora"), document_of("plain"), at(sim::Fidelity::draft));
    const std::string folder = people.box().folder().string();
    const Ran json = run({"status", folder, "--json"}), words = run({"status", folder}), top = run({"top", folder});
    REQUIRE(json.code == 0);
    CHECK(parse_json(json.out).value().at("sessions").at(0).at("person") == "dora");
    for (const Ran& ran : {words, top}) {
        CHECK(ran.code == 0);
        CHECK(ran.out.find("1 session") != std::string::npos);
        CHECK(ran.out.find("dora") != std::string::npos);
        CHECK(ran.out.find('\033') == std::string::npos);  // no terminal, no colours
        CHECK(widest_line(ran.out) <= 200);
    }
    const std::string token_file = folder + "/../token";
    REQUIRE(write_file(token_file, people.place("abel").token + "\n"));
    const Ran far = run({"status", "--on", people.url(), "--token-file", token_file});
    CHECK(far.code == 0);
    CHECK(far.out.find("dora") == std::string::npos);
    REQUIRE(write_file(token_file, "wrong\n"));
    CHECK(run({"status", "--on", people.url(), "--token-file", token_file}).code == 4);
    CHECK(run({"status", "--on", people.url(), "--fingerprint", std::string(64, 'a')}).code == 2);
    CHECK(run({"status", folder + "/none"}).code == 5);
    CHECK(run({"top", folder + "/none"}).code == 5);
}

TEST_CASE("top fills a terminal and no more, and leaves it as it was") {
    const Box box;
    Followed one(box, document_of("plain"), at(sim::Fidelity::draft)), other(box, document_of("plain"), at(sim::Fidelity::draft));
    for (const auto& [columns, lines] : {std::pair<unsigned short, unsigned short>{80, 24}, {200, 50}, {40, 10}, {20, 5}}) {
        INFO(columns << " columns");
        AtTerminal top({"top", box.folder().string()}, columns, lines);
        REQUIRE(top.shows("STATE"));
        top.screen.clear();
        REQUIRE(top.shows("\033[H\033[J"));  // it renews itself
        top.screen.clear();
        REQUIRE(top.shows("\033[H\033[J"));
        const std::string screen = top.screen.substr(0, top.screen.find("\033[H\033[J"));
        CHECK(widest_line(screen) <= columns);
        CHECK(std::count(screen.begin(), screen.end(), '\n') < lines);
        top.type("\003");
        CHECK(top.wait() == 0);
        CHECK(top.screen.find("\033[?1049l") != std::string::npos);
        CHECK(top.screen.find("\033[?25h") != std::string::npos);
        CHECK(top.is_as_before());
    }
    CHECK(box.status().at("sessions").size() == 2);
}

TEST_CASE("a table is never wider or longer than it may be, whatever the texts in it") {
    Json status{{"up_s", 1e9}, {"threads", 1024}, {"turns_waiting", 10000}, {"clients", 512}, {"memory", {{"bytes", 1ULL << 50}, {"promised_bytes", 1ULL << 49}}},
                {"sessions", Json::array()}, {"jobs", Json::array()}};
    for (int k = 0; k < 100; ++k) {
        status["sessions"].push_back({{"session", 9007199254740991}, {"phase", "running"}, {"step", 9007199254740991}, {"residual", 1e300}, {"points", 67108864}, {"steps_per_second", 1e12},
                                      {"clients", 3}, {"memory_bytes", 1ULL << 40}, {"computed_s", 1e9}, {"person", std::string(100, 'x')}, {"title", "Schuhgr\u00f6\u00dfe \033[2J\n\u7e54\u7269\u7e54\u7269\u7e54\u7269\u7e54\u7269\u7e54\u7269\u7e54\u7269"}});
    }
    for (const std::size_t columns : {1, 10, 20, 80, 119, 120, 131, 132, 133, 200}) {
        for (const std::size_t lines : {1, 4, 5, 6, 24, 200}) {
            INFO(columns << "x" << lines);
            const std::string table = status_table(status, columns, lines);
            CHECK(widest_line(table) <= columns);
            CHECK(static_cast<std::size_t>(std::count(table.begin(), table.end(), '\n')) <= std::max<std::size_t>(lines, 5));
            CHECK(table.find('\033') == std::string::npos);
            CHECK_NOTHROW(Json(table).dump());  // no character was cut in two
        }
    }
}

TEST_CASE("on a narrow terminal columns that say less are left out, and the title has what is left") {
    const Json job{{"job", 7}, {"phase", "running"}, {"person", "alice"}, {"step", 1200}, {"residual", 1e-3}, {"points", 288}, {"steps_per_second", 84.0}, {"memory_bytes", 1 << 30},
                   {"computed_s", 61.0}, {"left_s", 9.0}, {"title", "A shoe of three layers and a seam"}};
    const Json status{{"up_s", 1}, {"threads", 2}, {"turns_waiting", 0}, {"clients", 1}, {"memory", {{"bytes", 1 << 30}, {"promised_bytes", 0}}}, {"sessions", Json::array()}, {"jobs", {job}}};
    const auto line = [&](std::size_t columns, int number) {
        std::string table = status_table(status, columns, 10);
        for (; number > 0; --number) table.erase(0, table.find('\n') + 1);
        return table.substr(0, table.find('\n'));
    };
    CHECK(line(80, 2) == "     STATE    PERSON           STEPS   PER S  RESIDUAL    MEMORY TITLE");
    CHECK(line(80, 3) == "j7   running  alice             1200      84   1.0e-03   1.0 GiB A shoe of thre~");
    CHECK(line(60, 3) == "j7   running  alice             1200      84 A shoe of thre~");
    CHECK_THAT(line(140, 2), Catch::Contains("POINTS") && Catch::Contains("LEFT") && Catch::Contains("COMPUTED"));
    CHECK_THAT(line(140, 3), Catch::Contains("1 min 01 s") && Catch::Contains("A shoe of three layers and a "));
}

TEST_CASE("every command explains itself, and a call that makes no sense is a usage error") {
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{{}, {"serve"}, {"token"}, {"token", "add"}, {"token", "remove"}, {"token", "list"}, {"status"}, {"top"}, {"job"}}) {
        std::vector<std::string> help = words;
        help.emplace_back("--help");
        const Ran ran = run(help);
        INFO(ran.out);
        CHECK(ran.code == 0);
        CHECK(ran.out.find("Usage") != std::string::npos);
        CHECK(widest_line(ran.out) <= 160);
    }
    CHECK(run({"--version"}).code == 0);
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {}, {"nonsense"}, {"serve", "--port", "99999"}, {"serve", "--port", "x"}, {"serve", "a", "b"}, {"token"}, {"token", "add"}, {"token", "add", "x"}, {"worker", "x"}, {"top", "--on"}}) {
        INFO((words.empty() ? "nothing" : words.back()));
        CHECK(run(words).code == 2);
    }
}
