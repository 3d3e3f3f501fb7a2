// Evidence that a machine signed, on its way from a simulation server or a file to the mill.

#include "submit_case.hpp"

#include <weave/core/sha256.hpp>
#include <weave/keys/server_key.hpp>

#include <studio/panels/simulation_servers.hpp>

#include <support/scripted_simd.hpp>

#include <QMenu>
#include <QToolButton>

#include <algorithm>

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;
using weave::testing::JobResult;
using weave::testing::ScriptedSimd;

namespace {

/// What a simulation would report of a whole cloth that came to rest.
Json report_of(const Design& design) {
    const BlockPtr cloth = evaluate(design).value().block;
    const std::size_t picks = cloth->picks(), ends = cloth->ends();
    return {{"design_sha256", design_sha256(design)},
            {"scene_sha256", scene_sha256(design)},
            {"yarns_sha256", sha256_hex("yarns")},
            {"coverage",
             {{"picks", {1, picks}},
              {"ends", {1, ends}},
              {"of", {{"picks", picks}, {"ends", ends}}},
              {"whole", true}}},
            {"plan", {{{"term", "friction"}, {"choice", "off"}, {"reason", "the scene has none"}}}},
            {"solver", "relax"},
            {"fidelity", "standard"},
            {"residual", 1e-4},
            {"converged", true},
            {"order_kept", true}};
}

wire::SignedEvidence signed_by(const KeyPair& key, const std::string& site, const Json& report) {
    auto made = wire::sign_evidence(key, site, report.dump(1), parse_utc("2026-11-26T12:00:00.000Z").value());
    if (!made) FAIL(made.error().text());
    return *std::move(made);
}

/// A job of the scripted server, which signs what it says of the design that it is sent.
ScriptedSimd::Work signing(const KeyPair& key, const std::string& site) {
    return [&key, site](const wire::Submit& submit) {
        const Json report = report_of(read_document(submit.document).value());
        return JobResult{{}, report, "yarns", wire::write_evidence(signed_by(key, site, report))};
    };
}

/// The servers that the person knows, for the time of a test.
struct KnownServer {
    explicit KnownServer(const std::string& host) { remember_servers({ServerWish{host, "", ""}}); }
    ~KnownServer() { remember_servers({}); }
};

/// Chooses in the menu of `Have it signed` as a person does, but for the pop-up itself.
void choose(SubmitWindow& window, const char* words) {
    auto& button = window.find<QToolButton>("sign_evidence");
    REQUIRE(button.isVisible());
    Q_EMIT button.menu()->aboutToShow();
    for (QAction* action : button.menu()->actions())
        if (action->text().contains(words) && action->isEnabled()) return action->trigger();
    FAIL("the menu has no entry " << words);
}

}  // namespace

TEST_CASE("submit: a simulation server signs what it finds, and the mill takes it with the revision") {
    const Mill mill;
    const KeyPair key = load_server_key(mill.enrol_machine(), ServerKeyRole::evidence).value();
    ScriptedSimd simd;
    simd.script()->work = signing(key, mill.site());
    const KnownServer known(simd.origin());
    SubmitWindow window(mill);
    window.type("new_design", "cloth");
    choose(window, "standard");
    window.wait_for("signed_evidence", "Signed: standard, at rest; it is filed with the revision");
    CHECK(simd.look([](ScriptedSimd& s) { return s.acknowledged_jobs.size(); }) == 1);
    window.submit("Simulated by a machine of the mill");
    window.wait_for("state", "Revision 1 is submitted");
    REQUIRE(window.wait([&] { return window.talk().contains("100 % of the crossings: standard, at rest"); }));

    // What has been signed is not filed for another design.
    window.open_sample("twill-2-2");
    CHECK(window.text("signed_evidence").contains("has changed since it was signed"));
    window.submit("Another weave");
    window.wait_for("state", "Revision 2 is submitted");
    const auto told = [&] { return window.talk().count("100 % of the crossings: standard, at rest"); };
    const auto before = told();

    // Signed after it was handed in, it is filed for the revision that there is.
    choose(window, "standard");
    window.wait_for("signed_evidence", "Signed: standard");
    window.click("file_evidence");
    REQUIRE(window.wait([&] { return told() == before + 1; }));
}

TEST_CASE("submit: evidence of a stranger is refused in words, and is no obstacle") {
    const Mill mill;
    const KeyPair stranger = KeyPair::generate();
    SubmitWindow window(mill);
    window.type("new_design", "cloth");
    const std::string file = mill.at("evidence.json");
    REQUIRE(write_file(file, wire::write_evidence(signed_by(stranger, mill.site(), report_of(window.design)))));
    window.panel.evidence().read_file(QString::fromStdString(file));
    window.wait_for("signed_evidence", "Signed: standard");
    window.submit("Simulated by a stranger");
    window.wait_for("trouble", "the signer is not enrolled");
    window.wait_for("state", "Revision 1 is submitted");
}

TEST_CASE("submit: signed evidence of another design, of another scene, and what is none are refused with the file") {
    const Mill mill;
    const KeyPair key = KeyPair::generate();
    SubmitWindow window(mill);
    const std::string file = mill.at("evidence.json");
    const auto refused = [&](const std::string& bytes, const char* words) {
        REQUIRE(write_file(file, bytes));
        window.panel.evidence().read_file(QString::fromStdString(file));
        window.wait_for("evidence_trouble", words);
        CHECK(window.text("evidence_trouble").contains(QString::fromStdString(file)));
        CHECK(window.panel.evidence().paper() == nullptr);
    };
    refused(wire::write_evidence(signed_by(key, mill.site(), report_of(find_sample("twill-2-2")->make()))),
            "is about another design");
    Design other = window.design;
    other.scene.gravity = !other.scene.gravity;
    refused(wire::write_evidence(signed_by(key, mill.site(), report_of(other))), "in another scene");
    refused("{}", "format");
    window.panel.evidence().read_file(QString::fromStdString(mill.at("nowhere.json")));
    window.wait_for("evidence_trouble", "No such file");
}

TEST_CASE("submit: a server that has no key, or gives evidence of something else, leaves the panel without; a job is cancelled") {
    const Mill mill;
    const KeyPair key = KeyPair::generate();
    ScriptedSimd simd;
    const KnownServer known(simd.origin());
    SubmitWindow window(mill);
    simd.script()->signs = false;
    simd.script()->work = signing(key, mill.site());
    choose(window, "reference");
    window.wait_for("evidence_trouble", "no key to sign evidence with");
    CHECK(simd.look([](ScriptedSimd& s) { return s.count_of<wire::Submit>(); }) == 0);

    simd.script()->signs = true;
    simd.script()->work = [&](const wire::Submit&) {
        const Json report = report_of(find_sample("twill-2-2")->make());
        return JobResult{{}, report, "yarns", wire::write_evidence(signed_by(key, mill.site(), report))};
    };
    choose(window, "reference");
    window.wait_for("evidence_trouble", "is about another design");
    CHECK(simd.look([](ScriptedSimd& s) {
        return std::ranges::any_of(s.heard, [](const wire::ClientMessage& message) {
            const auto* submit = std::get_if<wire::Submit>(&message);
            return submit != nullptr && submit->simulation.plan.fidelity == sim::Fidelity::reference;
        });
    }));

    simd.script()->holds_jobs = true;
    choose(window, "standard");
    REQUIRE(window.wait([&] { return simd.look([](ScriptedSimd& s) { return s.count_of<wire::Submit>(); }) == 2; }));
    window.click("cancel_evidence");
    REQUIRE(window.wait([&] { return window.find<QToolButton>("sign_evidence").isVisible(); }));
    CHECK(window.text("evidence_trouble").isEmpty());
    CHECK(simd.look([](ScriptedSimd& s) { return s.count_of<wire::Cancel>(); }) == 1);
    CHECK(window.text("signed_evidence").contains("Nothing is signed"));
}
