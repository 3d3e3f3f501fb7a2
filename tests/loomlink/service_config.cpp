#include <catch2/catch.hpp>

#include <loomlink/commands/config.hpp>

using namespace weave;
using namespace weave::loomlink;

TEST_CASE("a configuration is read, and what it leaves out stays as it is") {
    const auto config = parse_config(
        R"({"site":"mill","address":"0.0.0.0","port":9000,"hosts":["loom.example","10.0.0.7"],"workers":2})");
    REQUIRE(config);
    CHECK(config->address == "0.0.0.0");
    CHECK(config->port == 9000);
    CHECK(config->hosts == std::vector<std::string>{"loom.example", "10.0.0.7"});
    CHECK(client_hosts(*config) == config->hosts);
    CHECK(config->workers == 2);
    CHECK_FALSE(config->plain);
    CHECK(config->store.empty());
    CHECK(parse_config(R"({"store":"postgresql://a,b/mill","standby":"postgres://b/mill"})")->standby == "postgres://b/mill");
    REQUIRE(parse_config("{}"));
    CHECK(parse_config("{}")->port == 8443);
}

TEST_CASE("a configuration that is wrong is refused at its place") {
    for (const auto& [text, where] : std::vector<std::pair<std::string, std::string>>{
             {"", ""},
             {"[]", ""},
             {R"({"prot":9000})", "prot"},
             {R"({"port":"9000"})", "port"},
             {R"({"port":65536})", "port"},
             {R"({"port":-1})", "port"},
             {R"({"hosts":"x"})", "hosts"},
             {R"({"hosts":["x",1]})", "hosts[1]"},
             {R"({"workers":0})", "workers"},
             {R"({"plain":1})", "plain"},
             {R"({"address":""})", "address"},
             {R"({"plain":true,"address":"0.0.0.0"})", "address"},
             {R"({"heads":[]})", "heads"},
             {R"({"site":""})", "site"},
             {R"({"store":"loomlink.db"})", "store"},
             {R"({"store":"postgresql://db/mill\n"})", "store"},
             {R"({"store":7})", "store"},
             {R"({"standby":"mysql://db/mill"})", "standby"},
             {R"({"site":"a\nb"})", "site"},
             {R"({"certificate":"x.pem"})", "key"},
             {R"({"key":"x.key"})", "certificate"},
             {R"({"plain":true,"certificate":"x.pem","key":"x.key"})", "plain"},
         }) {
        INFO(text);
        const auto config = parse_config(text);
        REQUIRE_FALSE(config);
        CHECK(config.error().code == ErrorCode::bad_input);
        if (!where.empty()) CHECK(config.error().where == where);
    }
}

TEST_CASE("paths in a configuration count from its folder") {
    const auto config = parse_config(R"({"certificate":"tls/x.pem","key":"/etc/x.key","heads":"heads.jsonl"})", "/etc/mill");
    REQUIRE(config);
    CHECK(config->certificate == "/etc/mill/tls/x.pem");
    CHECK(config->key == "/etc/x.key");
    CHECK(config->heads == "/etc/mill/heads.jsonl");
}
