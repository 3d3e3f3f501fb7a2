// Role by state by action by authorship, by the workflow, by the API and past both, against a table of its
// own.

#include "flow_case.hpp"
#include "service_case.hpp"

#include <loomlink/service/handlers.hpp>
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
    {"release", {RevisionState::approved, RevisionState::released}, {PersonRole::approver}, true},
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
        if (!design) return bad_input("there is no such design");
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

/// An action on a revision, as abe tries it.
struct Attempt {
    std::string action;
    std::int64_t number = 0;
    std::optional<std::int64_t> supersedes;  ///< the release that the loom has
};

/// By the workflow, with a session that may still believe in roles that were taken away.
Result<Json> by_workflow(FlowSite& site, const Attempt& one) {
    Steps& steps = site.flow->steps();
    const Caller& caller = site.people.at("abe");
    const StepWish wish{"shoe", one.number, "because"};
    const Ask ask = site.ask("abe");
    if (one.action == "submit") return steps.submit(caller, ask, wish, {});
    if (one.action == "comment") return steps.comment(caller, ask, wish, 1, 1);
    if (one.action == "request-changes") return steps.request_changes(caller, ask, wish);
    if (one.action == "waive") return steps.waive(caller, ask, wish, "float.face", "EP 1");
    if (one.action == "release")
        return site.flow->releases().release(caller, ask,
                                             {"shoe", one.number, "EP 1", {1}, one.supersedes, "because"});
    return steps.approve(caller, ask, wish);
}

/// The service of a site, and abe signed in there.
class Api {
  public:
    explicit Api(FlowSite& site) : m_site(site) {
        ServiceParts parts;
        parts.handlers = workflow_handlers(*site.flow, m_watchers);
        parts.session = [&site](const std::string& token) { return site.flow->accounts().who(token); };
        parts.refused = [&site](const Caller& caller, const std::string& request, const Deed& attempt,
                                const Error& error) {
            static_cast<void>(site.flow->refuse(caller, request, attempt, error));
        };
        parts.metrics = std::make_shared<net::Metrics>();
        parts.version = "test";
        m_server.emplace(got(net::Server::start(got(service_routes(parts)), net::ServerOptions())));
        net::ClientOptions options;
        options.port = m_server->port();
        m_client.emplace(options);
        const Json session = got(site.flow->accounts().log_in("abe", FlowSite::password("abe"), "10.0.0.1"));
        m_token = session.at("token").get<std::string>();
    }

    Result<Json> operator()(const Attempt& one) {
        Json body{{"request", m_site.ask().request}, {"reason", "because"}};
        body["password"] = FlowSite::password("abe");
        std::string path = "/designs/shoe/revisions/" + std::to_string(one.number) + "/" + one.action;
        if (one.action == "comment") body = {{"request", body["request"]}, {"text", "because"}};
        if (one.action == "waive") body.update({{"rule", "float.face"}, {"loom", "EP 1"}});
        if (one.action == "release") {
            path = "/releases";
            body.update({{"design", "shoe"}, {"revision", one.number}, {"loom", "EP 1"}});
            body["feeders"] = Json::array({1});
            if (one.supersedes) body["supersedes"] = *one.supersedes;
        }
        const net::Headers headers{{"Authorization", "Bearer " + m_token},
                                   {"Content-Type", "application/json"}};
        const net::Response answer = ask(*m_client, "POST", api_root + path, headers, body.dump());
        if (answer.status == 200) return json_of(answer);
        INFO(*answer.body);
        REQUIRE((answer.status == 403 || answer.status == 409));
        return Error{ErrorCode::refused, *answer.body, {}};
    }

  private:
    FlowSite& m_site;
    Watchers m_watchers;
    std::optional<net::Server> m_server;
    std::optional<net::HttpClient> m_client;
    std::string m_token;
};

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

/// So many refusals of one person are not all logged otherwise.
void log_each_refusal(FlowSite& site) {
    site.refusals.burst = 1e6;
    site.open();
}

/// Tries all of it by `attempt`. What is refused changes nothing, and is logged with the revision.
template <class Attempting>
void try_the_matrix(FlowSite& site, Attempting attempt) {
    site.set_policy();
    site.set_up_loom();
    got(site.flow->designs().add(site.people.at("dora"), site.ask(), "shoe"));
    std::size_t done = 0, refused = 0;
    std::optional<std::int64_t> on_the_loom;
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
                    const Result<Json> outcome = attempt(Attempt{row.action, number, on_the_loom});
                    if (!outcome) UNSCOPED_INFO(outcome.error().text());
                    REQUIRE(bool(outcome) == allowed(row, state, roles, own));
                    ++(outcome ? done : refused);
                    if (outcome && row.action == "release")
                        on_the_loom = outcome->at("number").get<std::int64_t>();
                    if (outcome) continue;
                    REQUIRE(site.dump() == before);
                    REQUIRE(site.kinds(size) == std::vector<std::string>{"refused"});
                    const Statement told = site.statements(size).front();
                    REQUIRE(told.actor == "abe");
                    REQUIRE(told.subject == "shoe");
                    REQUIRE(told.data.at("revision") == number);
                }
    }
    CHECK(done + refused == role_sets.size() * every_state.size() * 2 * matrix.size());
    CHECK(done > 0);
}

}  // namespace

TEST_CASE("role by state by action by authorship: what the table allows is done, all else changes nothing") {
    FlowSite site;
    site.is_tampered = true;  // states and roles are set past the workflow
    log_each_refusal(site);
    try_the_matrix(site, [&](const Attempt& one) { return by_workflow(site, one); });
}

TEST_CASE("the API does to a revision what role, state and authorship allow, and nothing else") {
    FlowSite site;
    site.is_tampered = true;  // states and roles are set past the workflow
    log_each_refusal(site);
    Api api(site);
    try_the_matrix(site, [&](const Attempt& one) { return api(one); });
}

TEST_CASE("past the workflow, the database lets nobody approve own work, or what was not submitted") {
    FlowSite site;
    site.is_tampered = true;
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
