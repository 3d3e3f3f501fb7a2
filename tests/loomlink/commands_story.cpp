#include "commands_case.hpp"

#include <algorithm>
#include <sstream>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;

TEST_CASE("a design goes from a first file to the loom and back by commands alone", "[commands]") {
    CommandMill mill;
    mill.set_up();
    CHECK(mode_of(mill.at("dora")) == 0600);
    CHECK(read_file(mill.at("dora")).value().find(CommandMill::password) == std::string::npos);
    CHECK(mill.done("mary", {"user", "list"}).at("people").size() == 5);
    CHECK(mill.done("mary", {"trust", "pending"}).at("changes").empty());

    CHECK(mill.save("twill-2-2").at("number") == 1);
    const Json second = mill.save("plain");
    CHECK(second.at("number") == 2);
    CHECK(second.at("expected") == 1);
    CHECK(mill.done("emil", {"design", "show", "cloth"}).at("revisions").size() == 2);
    CHECK(mill.done("dora", {"check", "cloth", "1", "--loom", "seven"}).at("errors") == 0);
    mill.done("dora", {"comment", "cloth", "1", "Is this wanted?", "--pick", "2"});
    CHECK(mill.signs("dora", {"submit", "cloth", "1", "--loom", "seven"}).at("state") == "submitted");
    const Ended own = mill.as("dora", {"approve", "cloth", "1", "--reason", "Mine"}, true);
    CHECK(own.code == 4);
    CHECK(own.json().at("error").at("exit") == 4);
    CHECK(mill.done("abel", {"me"}).at("waiting").size() == 1);
    CHECK(mill.signs("abel", {"approve", "cloth", "1"}).at("state") == "approved");
    CHECK(mill.release("1").at("state") == "released");

    const Json revision = mill.done("emil", {"design", "show", "cloth", "1"});
    CHECK(revision.at("state") == "released");
    CHECK(revision.at("comments").size() == 1);
    CHECK(revision.at("submission").at("by") == "The dora");
    CHECK(revision.at("submission").at("reason") == "It is so");
    CHECK(mill.done("emil", {"design", "show", "cloth", "2"}).at("submission").is_null());
    const std::string words = mill.run({"design", "show", "cloth", "1", "--session", mill.at("emil")}).out;
    CHECK_THAT(words, Catch::Contains("\nsubmitted  20") && Catch::Contains(" by The dora: It is so\n") && Catch::Contains("\napproved   20") &&
                          Catch::Contains(" by The abel: It is so\n") && Catch::Contains("\ncomment    20") &&
                          Catch::Contains(" by The dora, pick 2: Is this wanted?\n") && Catch::Contains("\nstate      released\n"));
    mill.done("emil", {"export", "cloth", "1", "-o", mill.at("back.weave")});
    CHECK(read_file(mill.at("back.weave")).value() == read_file(mill.at("twill-2-2.weave")).value());
    mill.done("emil", {"export", "cloth", "1", "-o", mill.at("bundle")});
    CHECK(parse_json(read_file(mill.at("bundle") / "cloth-1-bundle.json").value()));
    const Ended differs = mill.as("emil", {"diff", "cloth", "1", "2", "-o", mill.at("diff.png")});
    CHECK(differs.code == 1);
    CHECK(read_file(mill.at("diff.png")).value().starts_with("\x89PNG"));
    CHECK(mill.as("emil", {"diff", "cloth", "1", "1"}).code == 0);
    const Json log = mill.done("emil", {"log", "--design", "cloth", "--limit", "3"});
    CHECK(log.at("events").size() == 3);
    CHECK(mill.done("emil", {"log", "--from", "0", "--limit", "2"}).at("events")[0].at("seq") == 0);
}

TEST_CASE("a finding of one rule for one loom is waived with a reason, and nothing else passes by that",
          "[commands]") {
    CommandMill mill;
    mill.set_up();
    Json strict = parse_json(read_file(WEAVE_SOURCE_DIR "/db/looms/tc2.json").value()).value();
    strict["limits"] = {{"float_face", 1}, {"float_back", 1}};
    strict["severities"] = {{"float.face", "error"}, {"float.back", "error"}};
    REQUIRE(write_file(mill.at("strict.json"), strict.dump()));
    mill.done("mary", {"loom", "profile", "seven", mill.at("strict.json")});
    mill.save("twill-2-2");
    const auto waive = [&](const std::string& who, const std::string& rule) {
        return mill.as(who, {"waive", "cloth", "1", "--rule", rule, "--loom", "seven", "--reason", "Wanted"},
                       true);
    };
    const auto approve = [&] {
        return mill.as("abel", {"approve", "cloth", "1", "--reason", "Looked at"}, true);
    };
    CHECK(waive("abel", "float.face").code == 4);  // nobody has submitted it
    mill.signs("dora", {"submit", "cloth", "1"});
    CHECK(mill.as("abel", {"check", "cloth", "1", "--loom", "seven"}).code == 1);
    CHECK(approve().code != 0);
    CHECK(waive("emil", "float.face").code == 4);  // no approver
    CHECK(waive("dora", "float.face").code == 4);  // the author
    CHECK(mill.as("abel", {"waive", "cloth", "1", "--rule", "float.face", "--loom", "seven"}, true).code ==
          2);

    const Ended waived = waive("abel", "float.face");
    INFO(waived.err);
    REQUIRE(waived.code == 0);
    const Ended half = approve();
    CHECK(half.code != 0);
    CHECK_THAT(half.err, Catch::Contains("float.back") && !Catch::Contains("float.face"));
    const Ended in_words =
        mill.run({"waive", "cloth", "1", "--rule", "float.back", "--loom", "seven", "--reason", "Wanted too",
                  "--session", mill.at("abel"), "--password-file", mill.at("password")});
    CHECK(in_words.out == "cloth, revision 1: float.back waived for seven\n");
    CHECK(approve().code == 0);
    CHECK(mill.release("1").at("state") == "released");
    const Json waivers = mill.done("emil", {"design", "show", "cloth", "1"}).at("waivers");
    REQUIRE(waivers.size() == 2);
    CHECK(waivers.at(0) ==
          Json{{"rule", "float.face"}, {"loom", "seven"}, {"by", "The abel"}, {"reason", "Wanted"}});
}

TEST_CASE("the log in words tells a line a record: of what, why, and signed with which key", "[commands]") {
    CommandMill mill;
    mill.set_up();
    mill.save("twill-2-2");
    mill.approve("1");
    mill.release("1");
    REQUIRE(mill.run(mill.pull_words({"--trust", mill.trust_fingerprint()})).code == 0);
    const Json events = mill.done("emil", {"log", "--from", "0", "--limit", "1000"}).at("events");
    const Ended told = mill.run({"log", "--from", "0", "--limit", "1000", "--session", mill.at("emil")});
    REQUIRE(told.code == 0);
    std::vector<std::string> lines;
    std::istringstream all(told.out);
    for (std::string line; std::getline(all, line);) lines.push_back(line);
    REQUIRE(lines.size() == events.size());
    const std::string id = mill.done("abel", {"key", "show"}).at("id").get<std::string>();
    const std::string key = id.substr(0, 16);
    const auto says = [&](const std::string& kind, const std::vector<std::string>& pieces) {
        INFO(kind << " in\n" << told.out);
        CHECK(std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
            const auto holds = [&](const std::string& text) { return line.find(text) != std::string::npos; };
            return holds(" " + kind + " ") && std::all_of(pieces.begin(), pieces.end(), holds);
        }));
    };
    says("person.joined", {"mary", "roles admin"});
    says("person.invited", {"roles designer approver"});
    says("revision.saved", {"cloth", "branch main", "message \"A twill-2-2\""});
    says("revision.approved", {"revision 1", "because \"It is so\"", "signed by \"The abel\", key " + key});
    says("release.made", {"revision 1, loom seven, release 1", "signed by \"The abel\", key " + key});
    says("release.in_force", {"loom seven, release 1", "because"});
    says("release.pulled", {"otto", "loom seven, release 1", "file "});
    CHECK(told.out.find("password") == std::string::npos);
    CHECK(told.out.find(id) == std::string::npos);  // in full only in the JSON
}

TEST_CASE("a step that the server knows of already is refused with its reason", "[commands]") {
    CommandMill mill;
    mill.set_up();
    mill.save("twill-2-2");
    mill.approve("1");
    const Ended again = mill.as("dora", {"submit", "cloth", "1", "--reason", "Again"}, true);
    CHECK(again.code == 4);
    CHECK_THAT(again.err, Catch::Contains("designs/cloth/revisions/1/submit"));
    mill.save("plain");
    const Ended late =
        mill.as("dora", {"save", mill.at("plain.weave"), "cloth", "-m", "Late", "--expected", "1"});
    CHECK(late.code == 4);
    CHECK_THAT(late.err, Catch::Contains("moved on"));
    mill.release("1");
    const Ended beside = mill.as(
        "abel", {"release", "cloth", "1", "--loom", "seven", "--feeders", "1", "--reason", "More"}, true);
    CHECK(beside.code == 4);
    CHECK_THAT(beside.err, Catch::Contains("supersedes"));
    CHECK(mill.signs("emil", {"withdraw", "seven", "1"}).at("state") == "withdrawn");
    CHECK(mill.signs("dora", {"submit", "cloth", "2"}).at("state") == "submitted");
    CHECK(mill.signs("abel", {"request-changes", "cloth", "2"}).at("state") == "changes_requested");
    CHECK(mill.done("emil", {"faults", "seven"}).contains("faults"));
}

TEST_CASE("a policy that nobody can satisfy yet is put in force with a warning", "[commands]") {
    CommandMill mill;
    mill.set_up();
    const std::string approving = "Nothing can be approved until more join: the policy asks for 3 approvers, and there ";
    mill.done("mary", {"user", "disable", "abel"});
    Ended set = mill.as("mary", {"policy", "--approvals", "3"});
    CHECK(set.code == 0);
    CHECK(set.json().at("approvals") == 3);
    CHECK_THAT(set.err, Catch::Contains(approving + "is 1\n") && !Catch::Contains("released"));
    mill.done("mary", {"user", "enable", "abel"});
    set = mill.as("mary", {"policy", "--release-signatures", "2"});
    CHECK_THAT(set.err, Catch::Contains(approving + "are 2\n") && !Catch::Contains("released"));
    mill.invite("anna", {"approver"});
    set = mill.as("mary", {"policy", "--release-signatures", "3"});
    CHECK(set.code == 0);
    CHECK(set.err.empty());
}

TEST_CASE("two people sign where the policy asks for two", "[commands]") {
    CommandMill mill;
    mill.set_up();
    mill.invite("anna", {"approver"});
    CHECK(mill.done("mary", {"policy", "--release-signatures", "2"}).at("release_signatures") == 2);
    CHECK_FALSE(mill.done("mary", {"trust", "pending"}).at("changes").empty());
    mill.done("mary", {"trust", "publish"}, true);
    mill.save("twill-2-2");
    mill.approve("1");
    CHECK(mill.release("1").at("state") == "awaiting");
    CHECK(mill.signs("anna", {"sign", "seven", "1"}).at("state") == "released");
    const Json keys = mill.done("otto", {"key", "list"});
    CHECK(keys.at("keys").size() == 6);
    const std::string id = keys.at("keys")[0].at("id").get<std::string>();
    CHECK(mill.done("otto", {"key", "show", id.substr(0, 16)}).at("id") == id);
}

TEST_CASE("what a simulation found is signed by the machine that was enrolled, and counts", "[commands]") {
    CommandMill mill;
    mill.set_up();
    mill.done("mary", {"policy", "--simulation", "required"});
    mill.save("twill-2-2");
    mill.signs("dora", {"submit", "cloth", "1"});
    CHECK(mill.as("abel", {"approve", "cloth", "1", "--reason", "Good"}, true).code == 4);

    const Json code = mill.done("mary", {"signer", "invite", "gpu-1"});
    const std::string key = mill.at("evidence.key");
    const Json enrolled =
        mill.done("machine", {"signer", "enrol", code.at("code").get<std::string>(), "--server", mill.url(),
                              "--fingerprint", mill.fingerprint(), "--key-file", key});
    CHECK(enrolled.at("name") == "gpu-1");
    CHECK(mode_of(key) == 0600);
    const Json revision = mill.done("emil", {"design", "show", "cloth", "1"});
    const Json found{
        {"design_sha256", revision.at("design_sha256")},
        {"scene_sha256", revision.at("scene_sha256")},
        {"yarns_sha256", std::string(64, '7')},
        {"plan", {{{"term", "friction"}, {"choice", "off"}, {"reason", "the scene has none"}}}},
        {"coverage",
         {{"of", {{"picks", revision.at("picks")}, {"ends", revision.at("ends")}}}, {"whole", true}}},
        {"solver", "relax"},
        {"fidelity", "standard"},
        {"residual", 1e-4},
        {"converged", true},
        {"order_kept", true}};
    REQUIRE(write_file(mill.at("result.json"), found.dump()));
    mill.done("machine", {"evidence", "add", "cloth", "1", mill.at("result.json"), "--key-file", key});
    CHECK(mill.signs("abel", {"approve", "cloth", "1"}).at("state") == "approved");
    CHECK(mill.done("emil", {"evidence", "list", "cloth", "1"}).at("evidence").back().at("signer") ==
          "gpu-1");

    // The trust document is older than the machine: the audit tells it, until it is published again.
    const auto audit = [&](const std::vector<std::string>& more) {
        mill.done("mary", {"trust", "show", "-o", mill.at("trust.json")});
        mill.done("emil", {"audit", "bundle", "-o", mill.at("log.json")});
        std::vector<std::string> words{"audit", "verify", mill.at("log.json"), "--trust", mill.at("trust.json"), "--fingerprint", mill.trust_fingerprint()};
        words.insert(words.end(), more.begin(), more.end());
        const Ended ended = mill.run(words);
        INFO(ended.out << ended.err);
        CHECK(ended.code == 0);  // nothing was changed
        return ended;
    };
    CHECK(audit({"--json"}).json().at("machines_not_in_trust") == Json::array({"gpu-1"}));
    CHECK_THAT(audit({}).out, Catch::Contains("whose key the trust document does not name"));
    mill.done("mary", {"trust", "publish"}, true);
    CHECK(audit({"--json"}).json().at("machines_not_in_trust").empty());

    Json other = found;
    other["design_sha256"] = std::string(64, '0');
    REQUIRE(write_file(mill.at("other.json"), other.dump()));
    CHECK(mill.as("machine", {"evidence", "add", "cloth", "1", mill.at("other.json"), "--key-file", key})
              .code == 4);
    mill.done("mary", {"signer", "revoke", "gpu-1"});
    // What was approved on evidence that counts no more does not validate for the loom.
    CHECK(mill.as("abel", {"release", "cloth", "1", "--loom", "seven", "--reason", "Go"}, true).code == 1);
}

TEST_CASE("accounts are kept by commands: roles, passwords, a lost password", "[commands]") {
    CommandMill mill;
    mill.first_joins();
    mill.invite("dora", {"designer"});
    CHECK(mill.done("mary", {"user", "roles", "dora", "designer", "engineer"}).at("roles").size() == 2);
    mill.done("mary", {"user", "disable", "dora"});
    CHECK(mill.as("dora", {"design", "list"}).code == 4);
    mill.done("mary", {"user", "enable", "dora"});
    const std::string origin = mill.url();
    mill.done("dora", {"login"}, true);  // whoever signed in last, where that was
    const auto both = mill.put_private("both", std::string(CommandMill::password) + "\nquite another one\n");
    CHECK(mill.as("dora", {"user", "password", "--password-file", both}).code == 0);
    CHECK(mill.as("dora", {"login", "--name", "dora"}, true).code == 4);
    const Ended by_input = mill.run({"login", origin, "--session", mill.at("dora"), "--password-file", "-"},
                                    "quite another one\n");
    INFO(by_input.err);
    CHECK(by_input.code == 0);
    const Json anew = mill.done("mary", {"user", "reset", "dora"});
    CHECK(mill.as("dora", {"me"}).code == 4);
    mill.join(anew.at("link").get<std::string>(), "dora");
    CHECK(mill.done("dora", {"logout"}).at("signed_in") == false);
    CHECK(mill.as("dora", {"me"}).code == 4);
}
