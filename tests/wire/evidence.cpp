// What a simulation says that it found: from a report to a statement, signed, in a file, and back.

#include <weave/core/sha256.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/keys/signed_document.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/simulate.hpp>
#include <weave/sim/yarns_file.hpp>
#include <weave/wire/evidence.hpp>

#include <catch2/catch.hpp>

#include <functional>
#include <support/refusals.hpp>

using namespace weave;
using namespace weave::wire;
using weave::testing::check_refused;

namespace {

Instant noon() {
    return parse_utc("2026-11-26T12:00:00.000Z").value();
}

/// As `weave simulate --json` answers, but for members that no statement has.
Json report_of_a_part() {
    return {{"design_sha256", std::string(64, 'a')},
            {"scene_sha256", std::string(64, 'b')},
            {"yarns_sha256", sha256_hex("yarns")},
            {"coverage", {{"picks", {11, 20}}, {"ends", {1, 5}}, {"of", {{"picks", 100}, {"ends", 50}}}, {"whole", false}}},
            {"plan",
             {{{"term", "friction"}, {"choice", "off"}, {"reason", "the scene has none"}},
              {{"term", "region"}, {"choice", "picks 11-20"}, {"reason", "as asked for"}}}},
            {"solver", "relax"},
            {"fidelity", "standard"},
            {"residual", nullptr},
            {"converged", false},
            {"order_kept", true}};
}

SignedEvidence evidence_of(const KeyPair& key) {
    return sign_evidence(key, "mill", report_of_a_part().dump(1), noon()).value();
}

}  // namespace

TEST_CASE("a part of a cloth that was simulated becomes one region; what is no result is refused") {
    const Json part = report_of_a_part();
    auto statement = statement_of_result(part.dump(), noon());
    if (!statement) FAIL(statement.error().text());
    REQUIRE(statement->regions.size() == 1);
    CHECK(statement->regions[0].first_pick == 10);
    CHECK(statement->regions[0].picks == 10);
    CHECK(statement->regions[0].ends == 5);
    CHECK_FALSE(statement->residual);
    CHECK(statement->result_sha256 == sha256("yarns"));
    CHECK(statement->report_sha256 == sha256(part.dump()));
    CHECK(statement->at == utc_text(noon()));
    REQUIRE(statement->plan.size() == 2);
    CHECK(statement->plan[1].reason == "as asked for");
    statement->site = "mill";
    const Json body = statement_body(*statement);
    const auto again = read_simulation(body);
    REQUIRE(again);
    CHECK(canonical_json(statement_body(*again)) == canonical_json(body));
    CHECK(body.at("plan") == part.at("plan"));
    for (const char* member : {"design_sha256", "coverage", "converged", "order_kept", "fidelity", "yarns_sha256", "plan"}) {
        Json broken = part;
        broken.erase(member);
        INFO(member);
        CHECK_FALSE(statement_of_result(broken.dump(), noon()));
        broken[member] = 7;
        CHECK_FALSE(statement_of_result(broken.dump(), noon()));
    }
    for (const Json& span : {Json::array({1, 1}), Json::array({3, 1}), Json::array({1.5, 2}), Json("x")}) {
        Json false_whole = part;
        false_whole["coverage"]["whole"] = true;
        false_whole["coverage"]["picks"] = span;
        INFO(span.dump());
        CHECK_FALSE(statement_of_result(false_whole.dump(), noon()));
    }
    Json outside = part;
    outside["coverage"]["picks"] = {11, 101};
    CHECK_FALSE(statement_of_result(outside.dump(), noon()));
    outside["coverage"]["picks"] = {20, 11};
    CHECK_FALSE(statement_of_result(outside.dump(), noon()));
}

TEST_CASE("a plan that is no list of lines is refused, and so is one without end") {
    const auto with = [](const Json& plan) {
        Json report = report_of_a_part();
        report["plan"] = plan;
        return statement_of_result(report.dump(), noon());
    };
    const Json line{{"term", "t"}, {"choice", "c"}, {"reason", "r"}};
    CHECK(with(Json::array()));
    CHECK(with(Json(128, line)));
    check_refused(with(Json(129, line)), "plan: has more than 128 lines");
    check_refused(with("off"), "plan: must be a list");
    check_refused(with(Json::array({"off"})), "plan[0]");
    Json more = line;
    more["more"] = 1;
    check_refused(with(Json::array({line, more})), "plan[1].more: is not known here");
    more = line;
    more.erase("reason");
    check_refused(with(Json::array({more})), "reason");
    more = line;
    more["reason"] = std::string(4097, 'r');
    check_refused(with(Json::array({more})), "reason");
}

TEST_CASE("a statement has an end, whatever it is made of") {
    SimulationStatement statement = statement_of_result(report_of_a_part().dump(), noon()).value();
    statement.site = "mill";
    for (int k = 0; k < 15; ++k) statement.plan.push_back({"t", "c", std::string(4000, 'r')});
    CHECK(read_simulation(statement_body(statement)));
    statement.plan.push_back({"t", "c", std::string(4096, 'r')});
    statement.parameters["more"] = std::string(4096, 'p');
    check_refused(read_simulation(statement_body(statement)), "has more than 64 KiB");
}

TEST_CASE("what the simulator reports can be signed") {
    const Design design = find_sample("plain")->make();
    const auto evaluation = evaluate(design).value();
    const sim::Plan plan = sim::make_plan(design, *evaluation.block, {}).value();
    const Yarns yarns = sim::simulate(design, plan, {});
    Json report = yarns.report;
    check_refused(statement_of_result(report.dump(), noon()), "yarns_sha256");
    report["yarns_sha256"] = sha256_hex(write_yarns(yarns).value());
    const KeyPair key = KeyPair::generate();
    const auto evidence = sign_evidence(key, "mill", report.dump(), noon());
    if (!evidence) FAIL(evidence.error().text());
    const SimulationStatement statement = read_simulation(evidence->statement).value();
    CHECK(statement.plan.size() == plan.lines.size() + 1);  // and what computed
    CHECK(hash_hex(statement.result_sha256) == report.at("yarns_sha256"));
    CHECK(hash_hex(statement.design_sha256) == yarns.design_sha256);
    CHECK(statement.regions.empty());
    CHECK(statement.converged);
}

TEST_CASE("signed evidence is read as it was written, and shows who signed it") {
    const KeyPair key = KeyPair::generate(), other = KeyPair::generate();
    const SignedEvidence evidence = evidence_of(key);
    const std::string bytes = write_evidence(evidence);
    const auto read = read_evidence(bytes);
    if (!read) FAIL(read.error().text());
    CHECK(write_evidence(*read) == bytes);
    CHECK(read->report == report_of_a_part().dump(1));
    CHECK(read_simulation(read->statement).value().site == "mill");
    CHECK(verify_body(key.public_key(), Purpose::evidence, read->statement, read->signature));
    CHECK_FALSE(verify_body(other.public_key(), Purpose::evidence, read->statement, read->signature));
    CHECK(is_evidence(parse_json(bytes).value()));
    CHECK_FALSE(is_evidence(report_of_a_part()));
    CHECK_FALSE(is_evidence(Json::array()));
    CHECK_FALSE(is_evidence({{"format", 7}}));
}

TEST_CASE("evidence that does not hold together is refused, each for its reason") {
    const KeyPair key = KeyPair::generate();
    const Json good = parse_json(write_evidence(evidence_of(key))).value();
    const auto with = [&](const std::function<void(Json&)>& change) {
        Json json = good;
        change(json);
        return read_evidence(canonical_json(json));
    };
    REQUIRE(with([](Json&) {}));
    check_refused(with([](Json& json) { json["report"] = json["report"].get<std::string>() + " "; }),
                  "report: is not the report that was signed");
    check_refused(with([](Json& json) { json["report"] = report_of_a_part(); }), "report");
    check_refused(with([](Json& json) { json.erase("report"); }), "report");
    check_refused(with([](Json& json) { json["format"] = "weave-evidence"; }), "format: must be weave-signed-evidence");
    check_refused(with([](Json& json) { json["version"] = 2; }), "newer than this program");
    check_refused(with([](Json& json) { json["more"] = 1; }), "more: is not known here");
    check_refused(with([](Json& json) { json["signature"]["more"] = 1; }), "signature.more: is not known here");
    check_refused(with([](Json& json) { json["signature"]["key"] = "ABC"; }), "signature.key");
    check_refused(with([](Json& json) { json["signature"].erase("value"); }), "signature.value");
    check_refused(with([](Json& json) { json["statement"]["coverage"] = 1; }), "statement.coverage");
    check_refused(with([](Json& json) { json["statement"]["result_sha256"] = "x"; }), "statement.result_sha256");
    check_refused(with([](Json& json) { json["statement"] = "x"; }), "statement: must be an object");
    check_refused(read_evidence(good.dump(1)), "canonical form");
    check_refused(read_evidence(canonical_json(good) + "\n"), "canonical form");
    check_refused(read_evidence(""), "is not JSON");
    check_refused(read_evidence("[]"), "must be an object");
    check_refused(read_evidence(std::string(most_evidence + 1, ' ')), "too large");
}

TEST_CASE("a report that nobody could file is not signed") {
    const KeyPair key = KeyPair::generate();
    Json report = report_of_a_part();
    check_refused(sign_evidence(key, "", report.dump(), noon()), "site");
    check_refused(sign_evidence(key, "mi\nll", report.dump(), noon()), "site");
    report["notes"] = std::string(most_report, 'n');
    check_refused(sign_evidence(key, "mill", report.dump(), noon()), "has more than 4 MiB");
    // As many line feeds as fit: its document is as large as one gets, and is read.
    Json thin = report_of_a_part();
    std::string text = thin.dump();
    text.insert(1, std::string(most_report - text.size(), '\n'));
    const std::string bytes = write_evidence(sign_evidence(key, "mill", text, noon()).value());
    CHECK(bytes.size() < most_evidence);
    CHECK(read_evidence(bytes));
}

TEST_CASE("a flipped bit anywhere in signed evidence is found") {
    const KeyPair key = KeyPair::generate();
    const std::string good = write_evidence(evidence_of(key));
    for (std::size_t k = 0; k < good.size(); ++k) {
        std::string bytes = good;
        bytes[k] = static_cast<char>(bytes[k] ^ 1);
        const auto read = read_evidence(bytes);
        INFO("byte " << k);
        CHECK_FALSE((read && verify_body(key.public_key(), Purpose::evidence, read->statement, read->signature)));
    }
}
