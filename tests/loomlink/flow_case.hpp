#pragma once

// A small site that is run through the workflow alone, at a cheap cost of passwords and a clock of its own.

#include "export_case.hpp"
#include "store_case.hpp"

#include <weave/core/file.hpp>
#include <weave/design/document.hpp>
#include <weave/keys/hex.hpp>

#include <catch2/catch.hpp>

#include <loomlink/workflow/retelling.hpp>
#include <loomlink/workflow/workflow.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace weave::loomlink::testing {

/// What an operation gave, or a failed test with its error.
template <class T>
T got(Result<T> result) {
    if (!result) FAIL("refused: " << result.error().text());
    return std::move(result).value();
}

/// The denial of a refusal; a failed test where it was done.
template <class T>
Denial denied(const Result<T>& result) {
    if (result) FAIL("was done");
    INFO(result.error().text());
    const auto denial = denial_of(result.error());
    REQUIRE(denial);
    return *denial;
}

struct FlowSite {
    Folder folder;
    std::string path = folder.store("store.db");
    Instant time = parse_utc("2026-11-26T08:00:00.000Z").value();
    ServerKeys keys{KeyPair::generate(), KeyPair::generate(), KeyPair::generate()};
    std::unique_ptr<Workflow> flow;
    std::map<std::string, Caller> people;
    net::ThrottleRate refusals = DeskSettings().refusals;  ///< that are logged; read by open()
    int requests = 0;
    bool is_tampered = false;  ///< the test changed the file behind the back of the workflow

    FlowSite() {
        static_cast<void>(Store::create(path, "mill").value());
        open();
        const Json first = got(flow->accounts().first_invitation());
        enter("ada", first.at("code"));
        for (const auto& [name, roles] :
             std::vector<std::pair<std::string, std::vector<std::string>>>{{"dora", {"designer"}},
                                                                           {"eve", {"designer", "approver"}},
                                                                           {"abe", {"approver"}},
                                                                           {"otto", {"operator"}},
                                                                           {"enno", {"engineer"}}})
            enter(name, got(flow->accounts().invite(people.at("ada"), ask(), roles)).at("code"));
    }

    /// Whatever a test did by the workflow, the tables say in the end what the log tells.
    ~FlowSite() {
        flow.reset();
        if (is_tampered) return;
        const auto findings = verify_tables(path);
        CHECK(findings);
        if (findings) CHECK(all_text(*findings) == "");
    }
    FlowSite(const FlowSite&) = delete;
    FlowSite& operator=(const FlowSite&) = delete;

    /// Opens the store that lies at `path` now, and leaves the one from before.
    void open() {
        flow.reset();
        flow = another(path);
    }
    /// One more program of the same site, on this store or a copy of it.
    [[nodiscard]] std::unique_ptr<Workflow> another(const std::string& place) {
        DeskSettings settings;
        settings.key_cost = settings.login_cost = test_cost();
        settings.refusals = refusals;
        return got(Workflow::open(got(Store::open(place)),
                                  {KeyPair::from_seed(keys.log.seed()), KeyPair::from_seed(keys.stamp.seed()),
                                   KeyPair::from_seed(keys.access.seed())},
                                  settings, [this] { return time; }));
    }

    static std::string password(const std::string& name) { return "the password of " + name; }
    void enter(const std::string& name, const std::string& code) {
        const Json joined =
            got(flow->accounts().join(code, name, "Full " + name, password(name), "10.0.0.1"));
        people[name] = got(flow->accounts().who(joined.at("token"))).caller;
    }

    /// A new request; with a name, signed with that person's password.
    Ask ask(const std::string& name = {}) {
        return {"request-" + std::to_string(++requests), name.empty() ? "" : password(name)};
    }

    /// Policy without simulations; with `wish` merged in.
    void set_policy(const Json& wish = Json::object()) {
        Json policy = got(flow->accounts().policy());
        policy["simulation"] = "optional";
        policy.update(wish);
        got(flow->accounts().set_policy(people.at("ada"), ask(), policy));
    }

    static std::string profile(const std::string& name) {
        return read_file(std::string(WEAVE_SOURCE_DIR) + "/db/looms/" + name + ".json").value();
    }
    /// The loom `EP 1` with its operator otto, and a trust document that lists the approvers.
    void set_up_loom() {
        got(flow->looms().add(people.at("ada"), ask(), "EP 1", profile("ep-2688")));
        got(flow->looms().set_operators(people.at("ada"), ask(), "EP 1", {"otto"}));
        got(flow->trust().publish(people.at("ada"), ask("ada"), false));
    }

    static std::string document(const std::string& title = "twill") {
        weave::Design design = weave::testing::design_of(
            weave::testing::card_of({"XX..XX..", ".XX..XX.", "..XX..XX", "X..XX..X"}), {1}, 1);
        design.title = title;
        return write_document(design);
    }
    /// Saves on main.
    std::int64_t save(const std::string& name, std::optional<std::int64_t> expected,
                      const std::string& title = "twill") {
        SaveWish wish{"shoe", "main", title, document(title), expected, {}};
        return got(flow->designs().save(people.at(name), ask(), wish)).at("number");
    }
    /// Revision `number` of shoe goes to `approved`.
    void approve(std::int64_t number, const std::string& author = "dora") {
        got(flow->steps().submit(people.at(author), ask(author), {"shoe", number, "ready"}, {}));
        got(flow->steps().approve(people.at("abe"), ask("abe"), {"shoe", number, "good"}));
    }
    std::string state(std::int64_t number) {
        return got(flow->designs().revision(people.at("enno"), "shoe", number)).at("state");
    }

    /// A simulation of the whole of a revision of shoe that counts.
    wire::SimulationStatement simulation_of(std::int64_t number) {
        const Json revision = got(flow->designs().revision(people.at("enno"), "shoe", number));
        wire::SimulationStatement found;
        found.site = "mill";
        found.at = "2026-11-26T08:00:00.000Z";
        found.design_sha256 = *parse_hash(revision.at("design_sha256").get<std::string>());
        found.scene_sha256 = *parse_hash(revision.at("scene_sha256").get<std::string>());
        found.report_sha256 = sha256("report");
        found.result_sha256 = sha256("yarns");
        found.plan = {{"friction", "off", "the scene has none"}};
        found.picks = 4;
        found.ends = 8;
        found.fidelity = "standard";
        found.solver = "weave 0.1.0";
        found.residual = 1e-4;
        found.converged = found.order_kept = true;
        return found;
    }

    /// All rows of all tables but the log's, as text.
    [[nodiscard]] std::string dump() const {
        const auto connection = got(sql::Connection::open(path, sql::Access::read));
        const auto tables = got(connection->all(
            connection->engine() == sql::Engine::sqlite
                ? "SELECT name FROM sqlite_schema WHERE type = 'table' ORDER BY name"
                : "SELECT tablename FROM pg_tables WHERE schemaname = current_schema() ORDER BY tablename",
            [](const sql::Row& row) { return row.bytes(0); }));
        std::string text;
        for (const std::string& table : tables) {
            if (table == "event" || table == "tree_node" || table == "tree_head") continue;
            const Status read = connection->each("SELECT * FROM " + table, [&](const sql::Row& row) {
                text += table;
                for (int k = 0; k < row.columns(); ++k) text += '|' + row.json(k).dump();
                text += '\n';
            });
            REQUIRE(read);
        }
        return text;
    }
    /// What the records from a number on say.
    [[nodiscard]] std::vector<Statement> statements(Seq from) const {
        std::vector<Statement> list;
        const auto events = flow->store().read([&](const Reader& reader) {
            return reader.events({from, 1000, {}, {}});
        });
        for (const auto& [seq, bytes] : got(events)) list.push_back(parse_record(bytes)->statement);
        return list;
    }
    [[nodiscard]] std::vector<std::string> kinds(Seq from) const {
        std::vector<std::string> list;
        for (const Statement& statement : statements(from)) list.push_back(statement.kind);
        return list;
    }
    [[nodiscard]] Seq log_size() const {
        return got(flow->store().read([](const Reader& reader) { return reader.log_size(); }));
    }
};

}  // namespace weave::loomlink::testing
