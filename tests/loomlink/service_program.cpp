#include "program.hpp"
#include "service_case.hpp"

#include <weave/core/file.hpp>

#include <support/postgres_server.hpp>
#include <support/temporary_folder.hpp>

using namespace weave;
using namespace weave::loomlink::testing;
using weave::testing::TemporaryFolder;

TEST_CASE("one command makes a site, serves it, and ends in good order when asked to") {
    const TemporaryFolder folder;
    const std::string told = folder.path / "told.txt", site = folder.path / "site";
    std::string code;
    {
        Program program({"serve", site, "--port", "0", "--host", "127.0.0.1", "--json"}, told);
        const std::string line = program.line();
        INFO(line << read_file(told).value());
        const Json started = parse_json(line).value();
        const auto url = started.at("url").get<std::string>();
        auto options = net::parse_origin(url).value();
        options.tls = net::Trust{{}, started.at("certificate_sha256").get<std::string>()};
        net::HttpClient client(options);
        CHECK(ask(client, "GET", "/healthz").status == 200);
        code = started.at("invitation").get<std::string>();
        REQUIRE(code.starts_with(url + "/join#"));
        code = code.substr(code.find('#') + 1);
        program.end(SIGTERM);
        CHECK(program.exit_code() == 0);
    }
    const std::string log = read_file(told).value();
    CHECK_THAT(log, Catch::Contains("ended"));
    CHECK(log.find(code) == std::string::npos);
}

TEST_CASE("a new site is told where it was made, and is made nowhere else than where it was meant") {
    namespace fs = std::filesystem;
    const TemporaryFolder folder;
    const std::string told = folder.path / "told.txt";
    const auto serve = [&](const std::string& site) {
        Program program({"serve", site, "--port", "0", "--plain", "--json"}, told);
        const Json answer = parse_json(program.line()).value();
        program.end(SIGTERM);
        return std::pair(answer, program.exit_code());
    };
    const auto [mistyped, mistyped_code] = serve(folder.path / "mils" / "site");
    CHECK(mistyped_code == 3);
    CHECK_THAT(mistyped.at("error").at("message").get<std::string>(), Catch::Contains("folder above it"));
    CHECK_FALSE(fs::exists(folder.path / "mils"));
    const fs::path letters = folder.path / "letters";
    fs::create_directory(letters);
    REQUIRE(write_file(letters / "letter.txt", "dear"));
    const auto [other, other_code] = serve(letters);
    CHECK(other_code == 4);
    CHECK_THAT(other.at("error").at("message").get<std::string>(), Catch::Contains("not empty"));
    CHECK(std::distance(fs::directory_iterator(letters), fs::directory_iterator()) == 1);
    REQUIRE(write_file(folder.path / "file", "x"));
    CHECK(serve(folder.path / "file").second != 0);

    const auto [made, made_code] = serve(folder.path / "." / "site");
    CHECK(made_code == 0);
    CHECK(made.at("made_in") == (folder.path / "site").string());
    const auto [again, again_code] = serve(folder.path / "site");
    CHECK(again_code == 0);
    CHECK_FALSE(again.contains("made_in"));

    fs::create_directory(folder.path / "empty");
    Program in_words({"serve", folder.path / "empty", "--port", "0", "--plain"}, told);
    CHECK(in_words.line() ==
          "There was no site in " + (folder.path / "empty").string() + ": made a new, empty one");
    in_words.end(SIGTERM);
    in_words.exit_code();
}

TEST_CASE("init makes a site once") {
    const TemporaryFolder folder;
    const std::string told = folder.path / "told.txt", site = folder.path / "site";
    Program first({"init", site, "--site", "the mill", "--json"}, told);
    const Json made = parse_json(first.line()).value();
    CHECK(made.at("site") == "the mill");
    CHECK(made.at("made_in") == site);
    CHECK(made.contains("code"));
    CHECK(first.exit_code() == 0);
    Program mistyped({"init", folder.path / "mils" / "site", "--json"}, told);
    CHECK(mistyped.exit_code() == 3);
    CHECK_FALSE(std::filesystem::exists(folder.path / "mils"));
    Program strange({"init", folder.path / "strange", "--host", "loom.mill", "--host", "no such host", "--json"}, told);
    const Json refused = parse_json(strange.line()).value().at("error");
    CHECK(refused.at("where") == "--host");
    CHECK(strange.exit_code() == 3);
    CHECK_FALSE(std::filesystem::exists(folder.path / "strange"));
    Program second({"init", site, "--json"}, told);
    CHECK(parse_json(second.line()).value().at("error").at("exit") == 4);
    CHECK(second.exit_code() == 4);
}

TEST_CASE("a configuration is checked without serving, and says whether it could be served") {
    const TemporaryFolder folder;
    const std::string told = folder.path / "told.txt", config = folder.path / "loomlink.json", site = folder.path / "site";
    const auto check = [&](std::vector<std::string> more = {}) {
        more.insert(more.begin(), {"serve", site, "--check-config", "--json"});
        Program program(more, told);
        const Json answer = parse_json(program.line()).value();
        return std::pair(answer, program.exit_code());
    };
    const auto refused = [&](const std::pair<Json, int>& ran, int code, const std::string& where) {
        CHECK(ran.second == code);
        CHECK(ran.first.at("error").at("where") == where);
    };
    REQUIRE(write_file(config, R"({"port":0})"));
    CHECK(check({"--config", config}) == std::pair(Json{{"valid", true}}, 0));
    CHECK_FALSE(std::filesystem::exists(site));
    REQUIRE(write_file(config, R"({"prot":9000})"));
    refused(check({"--config", config}), 3, config + ": prot");
    refused(check({"--plain", "--cert", "x.pem", "--key", "x.key"}), 3, "--plain");
    refused(check({"--port", "0", "--host", "a b"}), 3, "--host[0]");
    REQUIRE(write_file(config, R"({"port":0,"heads":"none/heads.jsonl"})"));
    refused(check({"--config", config}), 3, config + ": heads: " + (folder.path / "none/heads.jsonl").string());

    Program serving({"serve", site, "--port", "0", "--plain", "--json"}, told);
    const std::string url = parse_json(serving.line()).value().at("url");
    const std::string place = url.substr(url.find("//") + 2), port = place.substr(place.find(':') + 1);
    refused(check({"--port", port}), 5, "--port: " + place);
    REQUIRE(write_file(config, R"({"port":)" + port + "}"));
    refused(check({"--config", config}), 5, config + ": port: " + place);
    Program second({"serve", (folder.path / "other").string(), "--config", config, "--json"}, told);
    CHECK(second.exit_code() == 5);
    CHECK_FALSE(std::filesystem::exists(folder.path / "other"));
    serving.end(SIGTERM);
    CHECK(serving.exit_code() == 0);
}

TEST_CASE("a check of a configuration refuses what serving would refuse of the folder, its keys and its store") {
    const TemporaryFolder folder;
    const std::string told = folder.path / "told.txt", site = folder.path / "site", letters = folder.path / "letters";
    const auto refused = [&](const std::string& of, std::vector<std::string> more, int code, const std::string& words) {
        more.insert(more.begin(), {"serve", of, "--port", "0", "--json"});
        for (const bool only_checks : {true, false}) {
            INFO(words << (only_checks ? ", checked" : ", served"));
            if (only_checks) more.emplace_back("--check-config");
            Program program(more, told);
            const std::string answer = program.line();
            CHECK(program.exit_code() == code);
            CHECK_THAT(answer, Catch::Contains(words));
            if (only_checks) more.pop_back();
        }
    };
    REQUIRE(std::filesystem::create_directory(letters));
    REQUIRE(write_file(letters + "/letter.txt", "dear"));
    refused(letters, {}, 4, "is not empty");
    if (weave::testing::PostgresServer::is_installed()) {
        refused(site, {"--store", "postgresql://a:b@h/d"}, 3, "must hold no password");
        refused(site, {"--standby", "postgresql://a:b@h/d"}, 3, "must hold no password");
        refused(site, {"--store", "postgresql://localhost:1/d"}, 5, "no connection to the server");
        auto& server = weave::testing::PostgresServer::shared();
        const std::string full = server.make_database();
        server.run("CREATE TABLE theirs (x bigint)", full);
        refused(site, {"--store", server.place(full)}, 4, "another program's database");
        CHECK_FALSE(std::filesystem::exists(site));
    }
    REQUIRE(Program({"init", site, "--host", "localhost", "--json"}, told).exit_code() == 0);
    CHECK(Program({"serve", site, "--port", "0", "--check-config"}, told).exit_code() == 0);
    const auto without = [&](const std::string& name, const std::string& bytes, int code, const std::string& words) {
        const std::string kept = read_file(site + "/" + name).value();
        REQUIRE(write_file(site + "/" + name, bytes));
        refused(site, {}, code, words);
        REQUIRE(write_file(site + "/" + name, kept));
    };
    without("log.key", "no key", 3, "log.key");
    without("tls.pem", "no certificate", 3, "tls.pem");
    without("loomlink.db", std::string(5000, '.'), 5, "is damaged, or is no store");
}
