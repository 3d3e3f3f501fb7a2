// Whole stories of a mill, by the workflow alone.

#include "flow_case.hpp"

#include <loomlink/audit/told_keys.hpp>

namespace weave::loomlink::testing {

using Kinds = std::vector<std::string>;

TEST_CASE("from a saved design to a released file, its successor, a new profile and a recall") {
    FlowSite site;
    Workflow& flow = *site.flow;
    const auto& people = site.people;
    site.set_policy();
    site.set_up_loom();
    got(flow.designs().add(people.at("dora"), site.ask(), "shoe"));
    REQUIRE(site.save("dora", {}) == 1);
    site.approve(1);
    REQUIRE(site.state(1) == "approved");

    const ReleaseWish wish{"shoe", 1, "EP 1", {1}, {}, "for the spring order"};
    const Json made = got(flow.releases().release(people.at("abe"), site.ask("abe"), wish));
    CHECK(made.at("state") == "released");
    CHECK(site.state(1) == "released");

    const std::string trust_text = got(flow.trust().documents(1)).at("documents")[0];
    const TrustDocument trust = got(read_trust(trust_text));
    const std::string manifest = got(flow.releases().manifest(people.at("otto"), "EP 1", 1));
    const ReleaseManifest read = got(open_manifest(manifest, trust));
    for (const ReleasedFile& file : read.files) {
        const std::string bytes = got(flow.releases().file(people.at("otto"), "EP 1", 1, file.path));
        CHECK(hash_hex(sha256(bytes)) == file.sha256);
    }
    const std::string index_text = got(flow.releases().index(people.at("otto"), "EP 1", 1, 0)).at("index");
    const ReleaseIndex index = got(open_index(index_text, trust));
    REQUIRE(index.releases.size() == 1);
    CHECK(index.releases[0].manifest_sha256 == hash_hex(sha256(manifest)));

    REQUIRE(site.save("dora", 1, "twill two") == 2);
    site.approve(2);
    ReleaseWish next{"shoe", 2, "EP 1", {1}, {}, "better"};
    CHECK(denied(flow.releases().release(people.at("abe"), site.ask("abe"), next)) == Denial::conflict);
    next.supersedes = 1;
    got(flow.releases().release(people.at("abe"), site.ask("abe"), next));
    CHECK(site.state(1) == "superseded");
    CHECK(denied(flow.releases().manifest(people.at("otto"), "EP 1", 1)) == Denial::conflict);
    const ReleaseIndex later = got(open_index(
        got(flow.releases().index(people.at("otto"), "EP 1", 1, 0)).at("index").get<std::string>(), trust));
    CHECK(later.epoch > index.epoch);
    CHECK(later.find(1)->state == ReleaseState::superseded);

    got(flow.looms().confirm_loaded(people.at("otto"), site.ask(), "EP 1", 2));
    got(flow.looms().keep_place(people.at("otto"), site.ask(), "EP 1", 2, 3));
    CHECK(got(flow.looms().read(people.at("otto"), "EP 1")).at("loaded") == 2);
    Json profile = Json::parse(FlowSite::profile("ep-2688"));
    profile["revision"] = "another";
    got(flow.looms().set_profile(people.at("ada"), site.ask(), "EP 1", profile.dump()));
    CHECK(denied(flow.releases().manifest(people.at("otto"), "EP 1", 2)) == Denial::conflict);
    ReleaseWish again = next;
    again.supersedes.reset();
    got(flow.releases().release(people.at("abe"), site.ask("abe"), again));
    got(flow.releases().manifest(people.at("otto"), "EP 1", 3));
    got(flow.releases().withdraw(people.at("enno"), site.ask("enno"), "EP 1", 3, "wrong yarn"));
    CHECK(site.state(2) == "withdrawn");
    CHECK(denied(flow.releases().manifest(people.at("otto"), "EP 1", 3)) == Denial::conflict);
    const auto of_the_shoe = got(flow.store().read([](const Reader& reader) { return reader.events({0, 100, "release.withdrawn", "shoe"}); }));
    REQUIRE(of_the_shoe.size() == 1);
    CHECK(got(parse_record(of_the_shoe.front().second)).statement.reason == "wrong yarn");

    const auto log_key = site.keys.log.public_key();
    const BundleReport report = verify_bundle(
        got(flow.audit().bundle(people.at("enno"))),
        {[&](std::string_view bytes, const RecordSignature& signature) {
             return verify(log_key, Purpose::tree_head, bytes, {signature.key, signature.value});
         },
         {},
         {}});
    CHECK(report.clean());
    const auto told = told_keys(got(flow.audit().bundle(people.at("enno"))));
    CHECK(told.size() == people.size());
    for (const auto& [id, key] : told) {
        CHECK(key_id(key.key) == id);
        CHECK(got(flow.store().read([&](const Reader& reader) { return reader.key(id); }))->person ==
              people.at(key.holder).id);
    }
    const auto findings = verify_store(site.path);
    REQUIRE(findings);
    CHECK(all_text(*findings).empty());
}

TEST_CASE("a request that comes again is answered the same and done once") {
    FlowSite site;
    Workflow& flow = *site.flow;
    got(flow.designs().add(site.people.at("dora"), site.ask(), "shoe"));
    const SaveWish wish{"shoe", "main", "first", FlowSite::document(), {}, {}};
    const Ask once = site.ask();
    const Json answer = got(flow.designs().save(site.people.at("dora"), once, wish));
    const std::string before = site.dump();
    CHECK(got(flow.designs().save(site.people.at("dora"), once, wish)) == answer);
    CHECK(site.dump() == before);
    CHECK(denied(flow.designs().add(site.people.at("dora"), once, "other")) == Denial::conflict);
    CHECK(denied(flow.designs().add(site.people.at("eve"), once, "other")) == Denial::conflict);
}

TEST_CASE("who saves second on a branch is told, and merges") {
    FlowSite site;
    Workflow& flow = *site.flow;
    got(flow.designs().add(site.people.at("dora"), site.ask(), "shoe"));
    site.save("dora", {});
    site.save("dora", 1, "dora's");
    SaveWish late{"shoe", "main", "eve's", FlowSite::document("eve's"), 1, {}};
    const std::string before = site.dump();
    CHECK(denied(flow.designs().save(site.people.at("eve"), site.ask(), late)) == Denial::conflict);
    CHECK(site.dump() == before);
    late.branch = "eve";
    late.expected.reset();
    late.also = {1};
    CHECK(got(flow.designs().save(site.people.at("eve"), site.ask(), late)).at("number") == 3);
    SaveWish merge{"shoe", "main", "both", FlowSite::document("both"), 2, {3}};
    got(flow.designs().save(site.people.at("dora"), site.ask(), merge));
    const Json graph = got(flow.designs().graph(site.people.at("enno"), "shoe"));
    CHECK(graph.at("revisions")[0].at("parents") == Json::parse("[2,3]"));
    CHECK_FALSE(flow.designs().save(site.people.at("dora"), site.ask(),
                                    {"shoe", "main", "no design", "{\"format\":1}", 4, {}}));
}

TEST_CASE("a wrong password signs nothing, is logged, and stops working after a few tries") {
    FlowSite site;
    Workflow& flow = *site.flow;
    got(flow.designs().add(site.people.at("dora"), site.ask(), "shoe"));
    site.save("dora", {});
    const std::string before = site.dump();
    const Seq size = site.log_size();
    Ask wrong = site.ask();
    wrong.password = "not the password";
    CHECK(denied(flow.steps().submit(site.people.at("dora"), wrong, {"shoe", 1, "ready"}, {})) ==
          Denial::password);
    CHECK(site.kinds(size) == Kinds{"refused"});
    for (int k = 0; k < 4; ++k)
        static_cast<void>(flow.steps().submit(site.people.at("dora"), wrong, {"shoe", 1, "ready"}, {}));
    CHECK(denied(flow.steps().submit(site.people.at("dora"), site.ask("dora"), {"shoe", 1, "ready"}, {})) ==
          Denial::often);
    CHECK(site.dump() == before);
    site.time += std::chrono::minutes(10);
    got(flow.steps().submit(site.people.at("dora"), site.ask("dora"), {"shoe", 1, "ready"}, {}));
}

TEST_CASE("sessions slide, end, and are closed with the account; a new password opens the key") {
    FlowSite site;
    Accounts& accounts = site.flow->accounts();
    const auto log_in = [&](const std::string& password) {
        return accounts.log_in("dora", password, "10.0.0.2");
    };
    CHECK(denied(log_in("wrong password")) == Denial::who);
    const std::string token = got(log_in(FlowSite::password("dora"))).at("token");
    for (int k = 0; k < 5; ++k) {
        site.time += std::chrono::minutes(20);
        got(accounts.who(token));
    }
    site.time += std::chrono::minutes(31);
    CHECK(denied(accounts.who(token)) == Denial::who);
    got(accounts.change_password(site.people.at("dora"), site.ask(), FlowSite::password("dora"),
                                 "quite another one"));
    CHECK(denied(log_in(FlowSite::password("dora"))) == Denial::who);
    const std::string other = got(log_in("quite another one")).at("token");
    got(accounts.set_active(site.people.at("ada"), site.ask(), "dora", false));
    CHECK(denied(accounts.who(other)) == Denial::who);
    CHECK(denied(log_in("quite another one")) == Denial::who);
    CHECK(denied(accounts.set_active(site.people.at("ada"), site.ask(), "ada", false)) == Denial::conflict);
    const Json code = got(accounts.reset(site.people.at("ada"), site.ask(), "abe"));
    CHECK(denied(accounts.join(code.at("code"), "dora", "Dora", "yet another one", "")) == Denial::rights);
    got(accounts.join(code.at("code"), "abe", "Full abe", "yet another one", ""));
    CHECK(denied(accounts.join(code.at("code"), "abe", "Full abe", "yet another one", "")) == Denial::rights);
}

TEST_CASE("evidence counts for the very design and scene, from a signer that is enrolled") {
    FlowSite site;
    Workflow& flow = *site.flow;
    const KeyPair machine = KeyPair::generate();
    const Json code = got(flow.evidence().invite_signer(site.people.at("ada"), site.ask(), "gpu-1"));
    got(flow.evidence().enrol(code.at("code"), to_hex(machine.public_key()), "10.0.0.3"));
    got(flow.designs().add(site.people.at("dora"), site.ask(), "shoe"));
    site.save("dora", {});
    got(flow.steps().submit(site.people.at("dora"), site.ask("dora"), {"shoe", 1, "ready"}, {}));
    const auto approve = [&](std::int64_t number) {
        return flow.steps().approve(site.people.at("abe"), site.ask("abe"), {"shoe", number, "good"});
    };
    CHECK(denied(approve(1)) == Denial::conflict);
    const auto may_approve = [&] {  // as the page is told, which offers what may be done
        const Json told = got(flow.designs().revision(site.people.at("abe"), "shoe", 1));
        const auto may = told.at("may").get<std::vector<std::string>>();
        const bool offered = std::find(may.begin(), may.end(), "approve") != may.end();
        CHECK(told.at("needs_simulation") == !offered);
        return offered;
    };
    CHECK_FALSE(may_approve());

    wire::SimulationStatement found = site.simulation_of(1);
    const auto hand_in = [&](const KeyPair& key, std::int64_t number) {
        const Json body = statement_body(found);
        return flow.evidence().add("shoe", number, "evidence-1", body,
                                   key.sign(Purpose::evidence, canonical_json(body)), "report");
    };
    CHECK(denied(hand_in(KeyPair::generate(), 1)) == Denial::rights);
    found.fidelity = "draft";
    got(hand_in(machine, 1));
    CHECK(denied(approve(1)) == Denial::conflict);
    found.fidelity = "standard";
    got(hand_in(machine, 1));
    CHECK(may_approve());
    CHECK(got(approve(1)).at("state") == "approved");

    weave::Design changed = read_document(FlowSite::document()).value();
    changed.weft.density_picks_per_cm = 31;
    got(flow.designs().save(site.people.at("dora"), site.ask(),
                            {"shoe", "main", "denser", write_document(changed), 1, {}}));
    CHECK(denied(hand_in(machine, 2)) == Denial::conflict);
    const Json stale = got(flow.designs().revision(site.people.at("enno"), "shoe", 2)).at("evidence");
    REQUIRE(stale.size() == 2);
    CHECK_THAT(stale[0].at("stale").get<std::string>(), Catch::Contains("changed since revision 1"));
    got(flow.steps().submit(site.people.at("dora"), site.ask("dora"), {"shoe", 2, "ready"}, {}));
    CHECK(denied(approve(2)) == Denial::conflict);
}

TEST_CASE("two people sign where the policy asks for two; a revoked key has to be replaced") {
    FlowSite site;
    Workflow& flow = *site.flow;
    site.set_policy({{"release_signatures", 2}});
    site.set_up_loom();
    got(flow.designs().add(site.people.at("dora"), site.ask(), "shoe"));
    site.save("dora", {});
    site.approve(1);
    const ReleaseWish wish{"shoe", 1, "EP 1", {1}, {}, "go"};
    CHECK(got(flow.releases().release(site.people.at("abe"), site.ask("abe"), wish)).at("state") ==
          "awaiting");
    CHECK(denied(flow.releases().manifest(site.people.at("otto"), "EP 1", 1)) == Denial::conflict);
    CHECK(denied(flow.releases().sign(site.people.at("abe"), site.ask("abe"), "EP 1", 1, "go")) ==
          Denial::conflict);
    got(flow.releases().sign(site.people.at("eve"), site.ask("eve"), "EP 1", 1, "go"));
    got(flow.releases().manifest(site.people.at("otto"), "EP 1", 1));

    const Json code = got(flow.accounts().reset(site.people.at("ada"), site.ask(), "eve"));
    site.enter("eve", code.at("code"));
    got(flow.trust().publish(site.people.at("ada"), site.ask("ada"), false));
    CHECK(denied(flow.releases().manifest(site.people.at("otto"), "EP 1", 1)) == Denial::conflict);
    // Everybody sees that it waits, whose turn it is, and nobody can say that it is loaded.
    CHECK(got(flow.looms().read(site.people.at("otto"), "EP 1")).at("releases")[0].at("state") == "awaiting");
    CHECK(got(flow.releases().read(site.people.at("otto"), "EP 1", 1)).at("state") == "awaiting");
    const auto waits = [&](const std::string& who) {
        return got(flow.waiting(site.people.at(who))).at("items").dump().find("waits for your signature") !=
               std::string::npos;
    };
    CHECK(waits("eve"));
    CHECK_FALSE(waits("abe"));
    CHECK(got(flow.waiting(site.people.at("otto"))).at("items").empty());
    CHECK(denied(flow.looms().confirm_loaded(site.people.at("otto"), site.ask(), "EP 1", 1)) ==
          Denial::conflict);
    got(flow.releases().sign(site.people.at("eve"), site.ask("eve"), "EP 1", 1, "again"));
    CHECK(got(flow.releases().read(site.people.at("otto"), "EP 1", 1)).at("state") == "released");
    const std::string manifest = got(flow.releases().manifest(site.people.at("otto"), "EP 1", 1));
    const std::string newest = got(flow.trust().documents(2)).at("documents")[0];
    CHECK(open_manifest(manifest, got(read_trust(newest))));
}

TEST_CASE("the codes for the first administrator end with that one; who has the folder can make another") {
    Folder folder;
    const auto path = folder.store("store.db");
    DeskSettings settings;
    settings.key_cost = settings.login_cost = test_cost();
    static_cast<void>(Store::create(path, "mill").value());
    const auto flow = got(Workflow::open(Store::open(path).value(),
                                         {KeyPair::generate(), KeyPair::generate(), KeyPair::generate()}, settings));
    const Json first = got(flow->accounts().first_invitation());
    const Json second = got(flow->accounts().first_invitation());
    const auto join = [&](const Json& code, const std::string& name, const std::string& full_name) {
        return flow->accounts().join(code.at("code"), name, full_name, FlowSite::password(name), "10.0.0.1");
    };
    got(join(second, "ada", "Ada Ames"));
    CHECK(denied(join(first, "mallory", "Mallory")) == Denial::rights);
    CHECK(denied(flow->accounts().first_invitation()) == Denial::conflict);
    const Json recovery = got(flow->accounts().recovery_invitation());
    CHECK(denied(join(recovery, "bea", "ada AMES")) == Denial::conflict);  // people would take her for Ada
    for (const char* name : {" Bea", "Bea ", "Bea  B", "Bea\u00a0B"}) CHECK_FALSE(join(recovery, "bea", name));
    got(join(recovery, "bea", "Bea Ball"));
    CHECK(all_text(verify_tables(path).value()) == "");
}

TEST_CASE("the profile that is in force already ends no release") {
    FlowSite site;
    Workflow& flow = *site.flow;
    site.set_policy();
    site.set_up_loom();
    got(flow.designs().add(site.people.at("dora"), site.ask(), "shoe"));
    site.save("dora", {});
    site.approve(1);
    got(flow.releases().release(site.people.at("abe"), site.ask("abe"), {"shoe", 1, "EP 1", {1}, {}, "go"}));
    CHECK(denied(flow.looms().set_profile(site.people.at("ada"), site.ask(), "EP 1",
                                          FlowSite::profile("ep-2688"))) == Denial::conflict);
    got(flow.releases().manifest(site.people.at("otto"), "EP 1", 1));
}

TEST_CASE("a new branch starts where it is said to") {
    FlowSite site;
    Workflow& flow = *site.flow;
    got(flow.designs().add(site.people.at("dora"), site.ask(), "shoe"));
    site.save("dora", {});
    got(flow.designs().save(site.people.at("dora"), site.ask(),
                            {"shoe", "trial", "bolder", FlowSite::document("bolder"), 1, {}}));
    CHECK(got(flow.designs().revision(site.people.at("enno"), "shoe", 2)).at("parents") == Json::array({1}));
    CHECK(denied(flow.designs().save(site.people.at("dora"), site.ask(),
                                     {"shoe", "other", "x", FlowSite::document("x"), 9, {}})) == Denial::absent);
}

TEST_CASE("a fault at the loom waits for who made the revision, as long as the release is woven") {
    FlowSite site;
    Workflow& flow = *site.flow;
    site.set_policy();
    site.set_up_loom();
    got(flow.designs().add(site.people.at("dora"), site.ask(), "shoe"));
    site.save("dora", {});
    site.approve(1);
    got(flow.releases().release(site.people.at("abe"), site.ask("abe"), {"shoe", 1, "EP 1", {1}, {}, "go"}));
    const auto waiting = [&](const char* name) {
        return got(flow.waiting(site.people.at(name))).at("items");
    };
    CHECK(waiting("dora").empty());
    const auto report = [&](const char* text) {
        got(flow.looms().report_fault(site.people.at("otto"), site.ask(), "EP 1", 1, text, 2, 3));
    };
    report("it floats");
    site.time += std::chrono::minutes(1);
    report("it floats again");
    const Json items = waiting("dora");
    REQUIRE(items.size() == 1);
    CHECK(items[0] == Json{{"design", "shoe"},
                           {"revision", 1},
                           {"loom", "EP 1"},
                           {"release", 1},
                           {"state", "released"},
                           {"what", "2 faults reported at the loom"},
                           {"since", "2026-11-26T08:01:00.000Z"}});
    CHECK(waiting("eve").empty());
    got(flow.releases().withdraw(site.people.at("abe"), site.ask("abe"), "EP 1", 1, "it floats"));
    CHECK(waiting("dora").empty());
}

TEST_CASE("what a newer revision follows waits for its designer no more") {
    FlowSite site;
    Workflow& flow = *site.flow;
    got(flow.designs().add(site.people.at("dora"), site.ask(), "shoe"));
    const auto waiting = [&] { return got(flow.waiting(site.people.at("dora"))).at("items"); };
    site.save("dora", {});
    site.save("dora", 1, "twill again");
    REQUIRE(waiting().size() == 1);
    CHECK(waiting()[0].at("revision") == 2);
    got(flow.steps().submit(site.people.at("dora"), site.ask("dora"), {"shoe", 2, "ready"}, {}));
    CHECK(waiting().empty());
    got(flow.steps().request_changes(site.people.at("abe"), site.ask("abe"), {"shoe", 2, "no"}));
    REQUIRE(waiting().size() == 1);
    CHECK(waiting()[0].at("what") == "changes were requested");
    site.save("dora", 2, "satin");
    REQUIRE(waiting().size() == 1);
    CHECK(waiting()[0].at("what") == "a draft, not submitted yet");
}

}  // namespace weave::loomlink::testing
