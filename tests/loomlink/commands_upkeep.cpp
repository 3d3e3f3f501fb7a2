#include "commands_case.hpp"
#include "store_case.hpp"

#include <weave/keys/hex.hpp>
#include <weave/keys/key.hpp>

#include <algorithm>
#include <loomlink/commands/head_keeper.hpp>
#include <support/random.hpp>
#include <utility>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;
using weave::testing::for_all;
using weave::testing::Random;

namespace fs = std::filesystem;

namespace {

/// The public key of the log, as the newest trust document lists it.
std::string log_key_of(const CommandMill& mill) {
    const Json listed = mill.done("otto", {"key", "list"});
    for (const Json& key : listed.at("keys"))
        if (key.at("roles") == Json::array({"log"})) return key.at("public").get<std::string>();
    return {};
}

}  // namespace

TEST_CASE("the log as a bundle is verified offline; one flipped bit is found and the record named",
          "[commands]") {
    CommandMill mill;
    mill.set_up();
    mill.save("twill-2-2");
    mill.approve("1");
    mill.done("emil", {"audit", "head", "-o", mill.at("head.json")});
    mill.done("emil", {"audit", "bundle", "-o", mill.at("log.json")});
    mill.done("otto", {"trust", "show", "-o", mill.at("trust.json")});
    const std::string fingerprint = mill.trust_fingerprint();
    const std::string key = log_key_of(mill);
    mill.done("mary", {"policy", "--approvals", "2"});
    CHECK(mill.run(mill.pull_words({"--trust", mill.trust_fingerprint()})).code == 0);
    mill.stop();

    const auto verify = [&](std::vector<std::string> by) {
        std::vector<std::string> words{"audit", "verify", mill.at("log.json"), "--json"};
        words.insert(words.end(), by.begin(), by.end());
        return mill.run(words);
    };
    const Ended by_key = verify({"--key", key, "--retained", mill.at("head.json")});
    INFO(by_key.err);
    CHECK(by_key.code == 0);
    CHECK(by_key.json().at("retained") == true);
    CHECK(by_key.json().at("signatures_by_listed_keys") == 0);
    const Json by_trust = verify({"--trust", mill.at("trust.json"), "--fingerprint", fingerprint}).json();
    CHECK(by_trust.at("clean") == true);
    CHECK(verify({"--trust", mill.at("trust.json"), "--fingerprint", std::string(64, 'a')}).code == 1);
    CHECK(by_trust.at("signatures_by_listed_keys") > 0);
    CHECK(by_trust.at("signatures_by_listed_keys").get<int>() +
              by_trust.at("signatures_by_keys_of_the_log").get<int>() ==
          by_key.json().at("signatures_by_keys_of_the_log"));
    CHECK(verify({"--key", std::string(64, '0')}).code == 3);
    CHECK(verify({"--key", to_hex(KeyPair::generate().public_key())}).code == 1);
    // The terminal has seen a newer log than this copy.
    CHECK(verify({"--state", mill.at("state")}).code == 1);

    const std::string whole = read_file(mill.at("log.json")).value();
    const std::size_t from = whole.find("\"records\":["), to = whole.rfind("]}");
    const auto one_bit = [&](Random& random) {
        const std::size_t at = random.between(from + 12, to - 2);
        flip(mill.at("log.json"), at);
        const Ended flipped = verify({"--key", key});
        INFO("byte " << at << ": " << flipped.out);
        CHECK(flipped.code == 1);
        const Json found = flipped.json().at("findings");
        const auto line =
            static_cast<std::uint64_t>(std::count(whole.begin() + static_cast<std::ptrdiff_t>(from) + 12,
                                                  whole.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
        CHECK(
            std::any_of(found.begin(), found.end(), [&](const Json& one) { return one.at("seq") == line; }));
        REQUIRE(write_file(mill.at("log.json"), whole));
    };
    for_all(one_bit, 20);
}

TEST_CASE("a site is verified and backed up while it is served, and a backup becomes a site again",
          "[commands]") {
    CommandMill mill;
    mill.set_up();
    mill.save("twill-2-2");
    mill.approve("1");
    mill.release("1");
    mill.done("emil", {"audit", "head", "-o", mill.at("head.json")});
    const auto verify = [&](const fs::path& folder, std::vector<std::string> more = {}) {
        std::vector<std::string> words{"verify", folder, "--json"};
        words.insert(words.end(), more.begin(), more.end());
        return mill.run(words);
    };
    const Ended sound = verify(mill.site_folder, {"--retained", mill.at("head.json")});
    INFO(sound.out << sound.err);
    CHECK(sound.code == 0);
    CHECK(mill.run({"backup", mill.site_folder, mill.at("backup")}).code == 0);
    CHECK(mode_of(mill.at("backup")) == 0700);
    CHECK(mode_of(mill.at("backup") / "log.key") == 0600);
    CHECK(mill.run({"backup", mill.site_folder, mill.at("backup")}).code == 4);
    CHECK(mill.run({"restore", mill.at("backup"), mill.site_folder}).code == 4);  // it is being served
    CHECK(verify(mill.at("backup")).code == 0);
    CHECK(verify(mill.at("nothing")).code == 3);
    fs::create_directory(mill.at("letters"));
    REQUIRE(write_file(mill.at("letters") / "letter.txt", "dear"));
    CHECK(mill.run({"restore", mill.at("backup"), mill.at("letters")}).code == 4);
    CHECK(fs::exists(mill.at("letters") / "letter.txt"));

    mill.stop();
    CHECK(mill.run({"restore", mill.at("backup"), mill.at("again")}).code == 0);
    CHECK(verify(mill.at("again"), {"--retained", mill.at("head.json")}).code == 0);
    CHECK(mill.run({"restore", mill.at("backup"), mill.site_folder}).code == 0);
    mill.start();
    CHECK(mill.done("emil", {"design", "show", "cloth", "1"}).at("state") == "released");

    tamper_with(mill.at("backup") / "loomlink.db",
                "INSERT INTO person_role SELECT id, 'engineer' FROM person WHERE login = 'dora'");
    const Ended forged = verify(mill.at("backup"));
    CHECK(forged.code == 1);
    CHECK(forged.json().at("findings").at(0).at("place") == "person dora");
    const Ended refused = mill.run({"restore", mill.at("backup"), mill.at("forged")});
    CHECK(refused.code == 4);
    CHECK_THAT(refused.err, Catch::Contains("person dora"));
    CHECK_FALSE(fs::exists(mill.at("forged") / "loomlink.db"));
    tamper_with(mill.at("backup") / "loomlink.db",
                "DELETE FROM person_role WHERE role = 'engineer' AND person = (SELECT id FROM person WHERE "
                "login = 'dora')");

    flip(mill.at("backup") / "stamp.key", 30);
    const Ended damaged = verify(mill.at("backup"));
    CHECK(damaged.code == 1);
    CHECK(damaged.json().at("findings").at(0).at("place") == "stamp.key");
}

TEST_CASE("heads kept in a second place find out who rewrites the log, and a lost disk there is told",
          "[commands]") {
    CommandMill mill;
    mill.stop();
    mill.heads = mill.at("heads.jsonl");
    mill.start();
    mill.set_up();
    mill.stop();  // the newest is kept at the end at the latest
    const SignedTreeHead first = load_retained_head(mill.heads).value();
    REQUIRE(mill.run({"backup", mill.site_folder, mill.at("backup")}).code == 0);
    mill.start();
    mill.save("twill-2-2");
    mill.stop();
    CHECK(load_retained_head(mill.heads)->head.size > first.head.size);
    const auto verify = [&] {
        return mill.run({"verify", mill.site_folder, "--retained", mill.heads, "--json"}).code;
    };
    CHECK(verify() == 0);
    const std::string kept = read_file(mill.heads).value();
    REQUIRE(write_file(mill.heads, kept + "{\"head\":"));  // a line that was cut off
    CHECK(verify() == 0);
    REQUIRE(write_file(mill.heads, kept));

    const auto second_place = std::exchange(mill.heads, "");
    REQUIRE(mill.run({"restore", mill.at("backup"), mill.site_folder, "--replace"}).code == 0);
    mill.start();  // another history, signed by the same key
    for (const char* sample : {"satin-5", "rib", "basket"}) mill.save(sample);
    mill.stop();
    CHECK(mill.run({"verify", mill.site_folder, "--json"}).code == 0);  // by itself it is a good log
    mill.heads = second_place;
    CHECK(verify() == 1);

    mill.heads = mill.at("nowhere") / "heads.jsonl";
    const auto refused = mill.try_start();
    REQUIRE_FALSE(refused);
    CHECK(refused.error().where == mill.heads.string());
}

TEST_CASE("who has the folder of a site brings an administrator back, while it is not served", "[commands]") {
    CommandMill mill;
    mill.set_up();
    const std::vector<std::string> words{"user", "bootstrap", mill.site_folder, "--json"};
    CHECK(mill.run(words).code == 4);  // it is being served
    mill.stop();
    CHECK(mill.run({"user", "bootstrap", mill.at("nothing")}).code == 3);
    CHECK_FALSE(fs::exists(mill.at("nothing")));
    const std::string code = mill.run(words).json().at("code").get<std::string>();
    mill.start();
    mill.join(mill.url() + "/join#" + code, "bea");
    CHECK(mill.done("bea", {"user", "list"}).at("people").size() == 6);
    mill.stop();
    CHECK(mill.run({"verify", mill.site_folder}).code == 0);
}

TEST_CASE("a configuration whose places are not there is found before the site is served", "[commands]") {
    CommandMill mill;
    const auto file = mill.at("loomlink.json");
    for (const auto& [text, where] : std::vector<std::pair<std::string, std::string>>{
             {R"({"plain":true,"address":"0.0.0.0"})", "address"},
             {R"({"certificate":"no.pem","key":"no.key"})", "certificate"},
             {R"({"port":0,"heads":"nowhere/heads.jsonl"})", "heads"},
             {R"({"port":0,"heads":"."})", "heads"}}) {
        INFO(text);
        REQUIRE(write_file(file, text));
        const Ended ended = mill.run({"serve", mill.at("new"), "--config", file, "--check-config"});
        CHECK(ended.code == 3);
        CHECK_THAT(ended.err, Catch::Contains(where));
    }
    REQUIRE(write_file(file, R"({"port":0,"heads":"heads.jsonl"})"));
    CHECK(mill.run({"serve", mill.at("new"), "--config", file, "--check-config"}).code == 0);
    CHECK_FALSE(fs::exists(mill.at("new")));
}

TEST_CASE("a site that was changed past the program is not served", "[commands]") {
    CommandMill mill;
    mill.set_up();
    mill.stop();
    tamper_with(SiteFolder{mill.site_folder}.store().value(),
                "INSERT INTO person_role SELECT id, 'engineer' FROM person WHERE login = 'dora'");
    const auto refused = mill.try_start();
    REQUIRE_FALSE(refused);
    CHECK(refused.error().code == ErrorCode::refused);
    CHECK_THAT(refused.error().message, Catch::Contains("person dora") && Catch::Contains("loomlink verify"));
}

TEST_CASE("looms refuse a site that was put back to an older time, until it has other keys", "[commands]") {
    CommandMill mill;
    mill.set_up();
    mill.save("twill-2-2");
    mill.approve("1");
    mill.release("1");
    REQUIRE(mill.run({"backup", mill.site_folder, mill.at("backup")}).code == 0);
    mill.done("mary", {"policy", "--approvals", "2"});
    REQUIRE(mill.run(mill.pull_words({"--trust", mill.trust_fingerprint()})).code == 0);
    mill.stop();
    REQUIRE(mill.run({"restore", mill.at("backup"), mill.site_folder, "--replace"}).code == 0);
    mill.start();
    const Ended replayed = mill.run(mill.pull_words());
    CHECK(replayed.code == 4);
    CHECK_THAT(replayed.err, Catch::Contains("this terminal has seen"));

    mill.stop();
    REQUIRE(mill.run({"init", mill.at("fresh")}).code == 0);
    for (const char* key : {"log.key", "stamp.key"})
        fs::rename(mill.at("fresh") / key, mill.site_folder / key);
    mill.start();
    CHECK(mill.run(mill.pull_words()).code == 4);  // nobody vouches for the new keys yet
    mill.done("mary", {"trust", "publish"}, true);
    const Ended again = mill.run(mill.pull_words());
    INFO(again.err);
    CHECK(again.code == 0);
    CHECK(mill.run({"verify", mill.site_folder}).code == 0);
}
