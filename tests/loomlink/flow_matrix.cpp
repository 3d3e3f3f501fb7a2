// Role by state by action by authorship, by the workflow and past it, against a table of its own.

#include "flow_case.hpp"

#include <set>

namespace weave::loomlink::testing {

namespace {

/// Who may do what in which state, as README.md of the workflow says it; `own` where authors may as well.
struct MatrixRow {
    std::string action;
    std::set<RevisionState> states;
    std::set<PersonRole> roles;
    bool own;
};

const std::set<RevisionState> every_state{
    RevisionState::draft,    RevisionState::submitted, RevisionState::changes_requested,
    RevisionState::approved, RevisionState::released,  RevisionState::superseded,
    RevisionState::withdrawn};

const std::vector<MatrixRow> matrix{
    {"submit", {RevisionState::draft}, {PersonRole::designer}, true},
    {"comment", every_state, {PersonRole::designer, PersonRole::approver}, true},
    {"request-changes", {RevisionState::submitted}, {PersonRole::approver}, true},
    {"waive",
     {RevisionState::submitted, RevisionState::approved, RevisionState::released},
     {PersonRole::approver},
     false},
    {"approve", {RevisionState::submitted}, {PersonRole::approver}, false},
};

const std::vector<std::vector<PersonRole>> role_sets{
    {},
    {PersonRole::designer},
    {PersonRole::approver},
    {PersonRole::operator_},
    {PersonRole::engineer},
    {PersonRole::administrator},
    {PersonRole::designer, PersonRole::approver},
    {PersonRole::operator_, PersonRole::engineer, PersonRole::administrator}};

Status event_of(Writer& writer, Seq& event) {
    Statement statement{"mill", "test", "2026-11-26T08:00:00.000Z", "test", {}, {}, "test", Json::object()};
    WEAVE_TRY(event, writer.append(statement));
    return {};
}

Status go_to(Writer& writer, Id revision, RevisionState target, Id approver) {
    using S = RevisionState;
    std::vector<S> way;
    if (target != S::draft) way = {S::submitted};
    if (target == S::changes_requested) way.push_back(target);
    if (target == S::approved || target == S::released || target == S::superseded || target == S::withdrawn)
        way.push_back(S::approved);
    if (target == S::released || target == S::superseded || target == S::withdrawn)
        way.push_back(S::released);
    if (target == S::superseded || target == S::withdrawn) way.push_back(target);
    for (const S state : way) {
        Seq event = 0;
        WEAVE_CHECK_OK(event_of(writer, event));
        if (state == S::approved)
            WEAVE_CHECK_OK(writer.add_decision({revision, approver, DecisionKind::approve, event}));
        WEAVE_CHECK_OK(event_of(writer, event));
        WEAVE_CHECK_OK(writer.set_state(revision, state, event));
    }
    return {};
}

/// A revision of `author` in this state, approved by eve where it has to be.
std::int64_t revision_in(FlowSite& site, RevisionState state, const std::string& author) {
    static int count = 0;
    const auto made = site.flow->store().write([&](Writer& writer) -> Result<Revision> {
        WEAVE_TRY(const auto design, writer.design("shoe"));
        if (!design) return system_fault("there is no shoe");
        Revision revision;
        revision.design = design->id;
        revision.author = site.people.at(author).id;
        revision.at = "2026-11-26T08:00:00.000Z";
        revision.message = "trial " + std::to_string(++count);
        WEAVE_TRY(revision.document, writer.put_object(FlowSite::document()));
        revision.picks = 4;
        revision.ends = 8;
        WEAVE_CHECK_OK(event_of(writer, revision.event));
        WEAVE_TRY(Revision stored, writer.add_revision(revision));
        WEAVE_CHECK_OK(go_to(writer, stored.id, state, site.people.at("eve").id));
        return stored;
    });
    return got(made).number;
}

Result<Json> attempt(FlowSite& site, const std::string& action, const Caller& caller, std::int64_t number) {
    Steps& steps = site.flow->steps();
    const StepWish wish{"shoe", number, "because"};
    const Ask ask = site.ask(caller.login);
    if (action == "submit") return steps.submit(caller, ask, wish, {});
    if (action == "comment") return steps.comment(caller, ask, wish, 1, 1);
    if (action == "request-changes") return steps.request_changes(caller, ask, wish);
    if (action == "waive") return steps.waive(caller, ask, wish, "float.face", "EP 1");
    return steps.approve(caller, ask, wish);
}

bool allowed(const MatrixRow& row, RevisionState state, const std::vector<PersonRole>& roles, bool own) {
    bool has_role = false;
    for (const PersonRole role : roles) has_role = has_role || row.roles.contains(role);
    return has_role && row.states.contains(state) && (row.own || !own);
}

void set_roles(FlowSite& site, const std::string& name, const std::vector<PersonRole>& roles) {
    got(site.flow->store().write([&](Writer& writer) -> Result<Json> {
        WEAVE_TRY(auto person, writer.person(name));
        person->roles = roles;
        WEAVE_CHECK_OK(writer.update_person(*person));
        return Json();
    }));
}

}  // namespace

TEST_CASE("role by state by action by authorship: what the table allows is done, all else changes nothing") {
    FlowSite site;
    site.set_policy();
    got(site.flow->looms().add(site.people.at("ada"), site.ask(), "EP 1", FlowSite::profile("ep-2688")));
    got(site.flow->designs().add(site.people.at("dora"), site.ask(), "shoe"));
    std::size_t done = 0, refused = 0;
    for (const auto& roles : role_sets) {
        set_roles(site, "abe", roles);
        for (const RevisionState state : every_state)
            for (const bool own : {false, true})
                for (const MatrixRow& row : matrix) {
                    const std::int64_t number = revision_in(site, state, own ? "abe" : "dora");
                    INFO(row.action << " in " << word(state) << (own ? ", own" : ", another's"));
                    for (const PersonRole role : roles) UNSCOPED_INFO(word(role));
                    const std::string before = site.dump();
                    const Seq size = site.log_size();
                    // The session may still believe in roles that were taken away.
                    const auto outcome = attempt(site, row.action, site.people.at("abe"), number);
                    REQUIRE(bool(outcome) == allowed(row, state, roles, own));
                    ++(outcome ? done : refused);
                    if (outcome) continue;
                    REQUIRE(site.dump() == before);
                    REQUIRE(site.kinds(size) == std::vector<std::string>{"refused"});
                }
    }
    CHECK(done + refused == 8 * 7 * 2 * 5);
    CHECK(done > 0);
}

TEST_CASE("past the workflow, the database lets nobody approve own work, or what was not submitted") {
    FlowSite site;
    got(site.flow->designs().add(site.people.at("dora"), site.ask(), "shoe"));
    for (const RevisionState state : every_state)
        for (const bool own : {false, true}) {
            const std::int64_t number = revision_in(site, state, own ? "abe" : "dora");
            const std::string revision =
                "(SELECT id FROM revision WHERE number = " + std::to_string(number) + ")";
            const std::string decide = "INSERT INTO decision (revision, person, kind, event) VALUES (" +
                                       revision +
                                       ", (SELECT id FROM person WHERE login = 'abe'), 'approve', 1)";
            INFO(word(state) << (own ? ", own" : ", another's"));
            if (state == RevisionState::submitted && !own)
                REQUIRE_NOTHROW(tamper_with(site.path, decide));
            else
                REQUIRE_THROWS(tamper_with(site.path, decide));
            if (state != RevisionState::submitted || own)
                REQUIRE_THROWS(
                    tamper_with(site.path, "INSERT INTO revision_state (revision, event, state) VALUES (" +
                                               revision + ", (SELECT max(seq) FROM event), 'approved')"));
        }
}

}  // namespace weave::loomlink::testing
