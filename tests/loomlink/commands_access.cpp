// Between loomlink and simd: access tokens, the site's access key, and evidence that a machine signed.

#include "commands_case.hpp"

#include <weave/keys/access_token.hpp>
#include <weave/keys/server_key.hpp>
#include <weave/keys/signer.hpp>
#include <weave/wire/evidence.hpp>

#include <algorithm>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;

namespace {

Instant now() {
    return std::chrono::time_point_cast<std::chrono::milliseconds>(std::chrono::system_clock::now());
}

/// The report of a run about a revision that counts.
Json report_about(const Json& revision) {
    return {{"design_sha256", revision.at("design_sha256")},
            {"scene_sha256", revision.at("scene_sha256")},
            {"yarns_sha256", std::string(64, '7')},
            {"coverage", {{"of", {{"picks", revision.at("picks")}, {"ends", revision.at("ends")}}}, {"whole", true}}},
            {"plan", {{{"term", "friction"}, {"choice", "off"}, {"reason", "the scene has none"}}}},
            {"solver", "relax"},
            {"fidelity", "standard"},
            {"residual", 1e-4},
            {"converged", true},
            {"order_kept", true}};
}

std::vector<PublicKey> access_keys(const CommandMill& mill) {
    return {parse_public_key(mill.introduction.at("access_public").get<std::string>()).value()};
}

}  // namespace

TEST_CASE("a token for simd is told, or written for nobody else to read", "[commands]") {
    CommandMill mill;
    mill.set_up();
    const Json told = mill.done("dora", {"token", "--hours", "2"});
    const auto token = read_access_token(told.at("token").get<std::string>(), access_keys(mill), now());
    REQUIRE(token);
    CHECK(token->person == "dora");
    CHECK(token->expires - token->issued == std::chrono::hours(2));
    const Ended bare = mill.run({"token", "--session", mill.at("emil")});
    REQUIRE(bare.code == 0);
    CHECK(read_access_token(bare.out.substr(0, bare.out.size() - 1), access_keys(mill), now()).value().person == "emil");

    const auto file = mill.at("simd.token");
    const Json written = mill.done("dora", {"token", "-o", file});
    CHECK_FALSE(written.contains("token"));
    CHECK(mode_of(file) == 0600);
    std::string text = read_file(file).value();
    REQUIRE(text.back() == '\n');
    text.pop_back();
    CHECK(read_access_token(text, access_keys(mill), now()).value().expires - now() > std::chrono::hours(7));
    mill.done("dora", {"token", "-o", file});
    CHECK(read_file(file).value() != text + "\n");
    REQUIRE(::chmod(file.c_str(), 0644) == 0);
    CHECK(mill.as("dora", {"token", "-o", file}).code == 4);

    CHECK(mill.as("otto", {"token"}).code == 4);
    CHECK(mill.as("dora", {"token", "--hours", "13"}).code == 3);
    CHECK(mill.as("dora", {"token", "--hours", "0"}).code == 2);
    mill.done("mary", {"user", "disable", "emil"});
    CHECK(mill.as("emil", {"token"}).code == 4);
}

TEST_CASE("the access key is told to whoever sets up simd, and a site without one makes one", "[commands]") {
    CommandMill mill;
    mill.set_up();
    const auto file = mill.site_folder / "access.key";
    CHECK(mode_of(file) == 0600);
    const Json before = mill.introduction.at("access_public");
    const Json told = mill.done("otto", {"key", "access"});
    CHECK(told.at("public") == before);
    CHECK(told.at("site") == mill.introduction.at("site"));
    REQUIRE(mill.run({"backup", mill.site_folder, mill.at("backup")}).code == 0);
    CHECK(read_file(mill.at("backup") / "access.key").value() == read_file(file).value());

    mill.stop();
    mill.start();
    CHECK(mill.introduction.at("access_public") == before);
    mill.stop();
    REQUIRE(std::filesystem::remove(file));
    CHECK(mill.run({"verify", mill.site_folder}).code == 0);
    mill.start();
    CHECK(mode_of(file) == 0600);
    CHECK(mill.introduction.at("access_public") != before);
    CHECK(load_server_key(file, ServerKeyRole::access));
    mill.stop();
    REQUIRE(::chmod(file.c_str(), 0644) == 0);
    CHECK_FALSE(mill.try_start());
    CHECK(mill.run({"verify", mill.site_folder}).code == 1);
}

TEST_CASE("evidence that a machine signed is filed by whoever has it, alone or with the submission", "[commands]") {
    CommandMill mill;
    mill.set_up();
    mill.done("mary", {"policy", "--simulation", "required"});
    mill.save("twill-2-2");
    const Json code = mill.done("mary", {"signer", "invite", "gpu-1"});
    mill.done("machine", {"signer", "enrol", code.at("code").get<std::string>(), "--server", mill.url(), "--fingerprint",
                          mill.fingerprint(), "--key-file", mill.at("evidence.key")});
    const Signer signer = load_signer(mill.at("evidence.key")).value();
    CHECK(signer.site == mill.introduction.at("site"));
    CHECK(signer.name == "gpu-1");

    const Json revision = mill.done("emil", {"design", "show", "cloth", "1"});
    const std::string report = report_about(revision).dump(1);
    const auto sign = [&](const std::string& site, const std::string& name) {
        REQUIRE(write_file(mill.at(name), wire::write_evidence(wire::sign_evidence(signer.key, site, report, now()).value())));
        return mill.at(name).string();
    };
    const std::string good = sign(signer.site, "good.evidence"), foreign = sign("elsewhere", "foreign.evidence");
    REQUIRE(write_file(mill.at("result.json"), report));

    // What makes no sense is refused before anything is sent.
    CHECK(mill.as("dora", {"evidence", "add", "cloth", "1", mill.at("result.json")}).code == 2);
    CHECK(mill.as("dora", {"evidence", "add", "cloth", "1", good, "--key-file", mill.at("evidence.key")}).code == 2);
    CHECK(mill.as("dora", {"evidence", "add", "cloth", "1", foreign}).code == 4);
    const std::string bytes = read_file(good).value();
    REQUIRE(write_file(mill.at("damaged.evidence"), bytes.substr(0, bytes.size() - 1)));
    std::vector<std::string> submit{"submit", "cloth", "1", "--reason", "Ready", "--evidence", good, "--evidence"};
    submit.push_back(mill.at("damaged.evidence"));
    CHECK(mill.as("dora", submit, true).code == 3);
    submit.back() = foreign;
    CHECK(mill.as("dora", submit, true).code == 4);
    CHECK(mill.done("emil", {"design", "show", "cloth", "1"}).at("state") == "draft");

    submit.back() = sign(signer.site, "again.evidence");
    const Json submitted = mill.done("dora", submit, true);
    CHECK(submitted.at("state") == "submitted");
    CHECK(submitted.at("evidence_filed").size() == 2);
    const Json listed = mill.done("emil", {"evidence", "list", "cloth", "1"}).at("evidence");
    const auto from_machine = std::count_if(listed.begin(), listed.end(), [](const Json& one) { return one.at("signer") == "gpu-1"; });
    CHECK(from_machine == 2);  // the first was filed already when the foreign one was refused, and is filed once
    CHECK(listed.back().at("result_sha256") == std::string(64, '7'));
    CHECK(mill.signs("abel", {"approve", "cloth", "1"}).at("state") == "approved");
    CHECK(mill.done("dora", {"evidence", "add", "cloth", "1", good}).at("evidence").is_number());
}
