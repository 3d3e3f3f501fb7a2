// Control messages: the protocol's examples, what each member means, and what is refused.

#include <weave/wire/frame.hpp>
#include <weave/wire/message.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <set>
#include <support/random.hpp>
#include <wire/protocol.hpp>

using namespace weave;
using namespace weave::wire;
using weave::testing::for_all;
using weave::testing::property_cases;
using weave::testing::protocol_block;
using weave::testing::Random;

namespace {

const std::vector<std::string>& examples_of(const std::string& side) {
    static const std::vector<std::string> client = protocol_block("client"), server = protocol_block("server");
    return side == "client" ? client : server;
}

/// The example number `skip` of a type.
std::string example(const std::string& side, const std::string& type, std::size_t skip = 0) {
    for (const std::string& line : examples_of(side)) {
        if (parse_json(line).value().at("type") == type && skip-- == 0) return line;
    }
    FAIL("PROTOCOL.md has no example of " << type);
    return "";
}

template <class T>
T client(const std::string& type, std::size_t skip = 0) {
    return std::get<T>(read_client_message(example("client", type, skip)).value());
}
template <class T>
T server(const std::string& type, std::size_t skip = 0) {
    return std::get<T>(read_server_message(example("server", type, skip)).value());
}

std::string client_refusal(const std::string& text) {
    const auto message = read_client_message(text);
    return message ? "" : message.error().text();
}
std::string server_refusal(const std::string& text) {
    const auto message = read_server_message(text);
    return message ? "" : message.error().text();
}

/// An example with a member changed, by its path.
std::string with(const std::string& line, const std::string& path, const Json& value) {
    Json json = parse_json(line).value();
    json[Json::json_pointer(path)] = value;
    return json.dump();
}

}  // namespace

TEST_CASE("every example of the protocol is read, written as it stands, and every type has one") {
    std::set<std::size_t> seen;
    for (const std::string& line : examples_of("client")) {
        INFO(line);
        const auto message = read_client_message(line);
        REQUIRE((message ? "" : message.error().text()) == "");
        REQUIRE(write_message(*message) == line);
        seen.insert(message->index());
    }
    REQUIRE(seen.size() == std::variant_size_v<ClientMessage>);
    seen.clear();
    for (const std::string& line : examples_of("server")) {
        INFO(line);
        const auto message = read_server_message(line);
        REQUIRE((message ? "" : message.error().text()) == "");
        REQUIRE(write_message(*message) == line);
        seen.insert(message->index());
    }
    REQUIRE(seen.size() == std::variant_size_v<ServerMessage>);
}

TEST_CASE("a client's messages mean what the protocol says") {
    CHECK(client<Hello>("hello").versions == std::vector<std::uint64_t>{1});
    CHECK(client<Hello>("hello").client == "weave 0.1");
    const auto create = client<Create>("create");
    CHECK(create.request == "shoe-4711");
    CHECK(create.document == "{…}");
    CHECK(create.simulation.plan.fidelity == sim::Fidelity::standard);
    CHECK(create.simulation.plan.region == Region{0, 49, 0, 39});
    CHECK(create.simulation.plan.held == std::vector<std::array<std::size_t, 2>>{{3, 1}});
    CHECK(create.simulation.plan.relaxing_N_per_mm[0] == 0.5);
    CHECK_FALSE(create.simulation.plan.relaxing_N_per_mm[1]);
    CHECK(create.simulation.plan.reduce);
    CHECK(create.simulation.solver == sim::Solver::relax);
    CHECK(create.simulation.most_steps == 20000U);
    CHECK(create.simulation.start_from == sim::Fidelity::draft);
    CHECK_FALSE(create.simulation.residual);
    const auto attach = client<Attach>("attach");
    CHECK((attach.session == 7 && attach.seq == 41 && attach.frame == 300));
    CHECK(client<Run>("run").session == 7);
    CHECK(client<Pause>("pause").session == 7);
    CHECK(client<Step>("step").steps == 10);
    CHECK(client<ReadState>("read_state").request == "shoe-4711");
    CHECK(client<Checkpoint>("checkpoint").session == 7);
    CHECK(client<Close>("close").session == 7);
    const auto acknowledge = client<Acknowledge>("acknowledge");
    CHECK((acknowledge.session == 7 && acknowledge.seq == 41));
    CHECK(client<WantFrames>("frames").most_per_second == 30);
    CHECK(client<Submit>("submit").flips == std::vector<Flip>{{29, 25, true}});
    CHECK(client<ListJobs>("list_jobs").request == "shoe-4711");
    CHECK(client<Cancel>("cancel").job == 12);
    CHECK(client<AcknowledgeJob>("acknowledge_job").job == 12);
    CHECK(client<ListSessions>("list_sessions").request == "shoe-4711");
}

TEST_CASE("a change is one of four") {
    const auto parameters = std::get<Parameters>(client<MakeChange>("change", 0).change);
    CHECK(parameters.warp == SystemScene{1.02, {}, 1.1});
    CHECK(parameters.weft == SystemScene{});
    CHECK(std::get<Pins>(client<MakeChange>("change", 1).change).pins == std::vector<Pin>{{false, 4}});
    CHECK(std::get<Fields>(client<MakeChange>("change", 2).change).fields == std::vector<ForceField>{{{10, 5, 0}, 8, 0.2}});
    CHECK(std::get<Flip>(client<MakeChange>("change", 3).change) == Flip{29, 25, true});
}

TEST_CASE("a server's answers mean what the protocol says") {
    CHECK(server<Welcome>("welcome").version == 1);
    CHECK(server<Welcome>("welcome").person == "dora");
    CHECK(server<Unsupported>("unsupported").versions == std::vector<std::uint64_t>{1});
    const auto accepted = server<Accepted>("accepted");
    CHECK((accepted.session == 7U && !accepted.job && accepted.wait_s == 2.5));
    const auto refused = server<Refused>("refused");
    CHECK((refused.error.code == ErrorCode::refused && refused.error.where == "simulation" && refused.wait_s == 240.0));
    const auto state = server<State>("state");
    CHECK((state.phase == Phase::running && state.step == 1200 && state.residual == 0.015625 && state.lost_crossings == 0U));
    CHECK((state.seq == 41 && state.frame == 300 && state.layout == 3));
    for (const JobState& job : {server<JobList>("jobs").jobs.at(0), server<JobProgress>("job").state}) {
        CHECK((job.job == 12 && job.phase == JobPhase::running && job.title == "shoe"));
        CHECK((job.step == 840 && job.residual == 0.02 && job.left_s == 95.5 && job.lost_crossings == 0U));
    }
    const JobState waiting = server<JobList>("jobs").jobs.at(1);
    CHECK((waiting.phase == JobPhase::waiting && waiting.place == 2U && waiting.wait_s == 240.0 && !waiting.left_s));
    CHECK((!waiting.batch && server<JobProgress>("job", 1).state.batch == "Slurm 4711_3: running on n1, GPU 0"));
    const SessionSummary session = server<SessionList>("sessions").sessions.at(0);
    CHECK((session.session == 7 && session.title == "shoe" && session.phase == Phase::running && session.step == 1200));
    CHECK((session.residual == 0.015625 && session.points == 97232 && session.attached == 1));
    CHECK((!session.ended && !session.left_s && server<JobList>("jobs").signs));
    const SessionSummary ended = server<SessionList>("sessions").sessions.at(1);
    CHECK((ended.ended && ended.left_s == 82800.5 && ended.attached == 0));
    CHECK(server<JobEnded>("job_ended").phase == JobPhase::done);
    CHECK(server<JobEnded>("job_ended").report.at("converged") == true);
    CHECK_FALSE(server<JobEnded>("job_ended").evidence);
    CHECK(server<JobEnded>("job_ended", 1).evidence->at("format") == "weave-signed-evidence");
    CHECK((server<Gap>("gap").first == 301 && server<Gap>("gap").last == 340));
}

TEST_CASE("a server's events mean what the protocol says") {
    const auto layout = server<Layout>("layout");
    CHECK((layout.seq == 1 && layout.layout == 3 && layout.is_periodic[0] && !layout.is_periodic[1] && layout.repeats[0] == 4));
    REQUIRE(layout.yarns.size() == 2);
    const LayoutYarn &weft = layout.yarns[0], &warp = layout.yarns[1];
    CHECK((weft.system == System::weft && weft.radius_mm == 0.2 && weft.colour == Colour{0x30, 0x60, 0xa0} && weft.points == 3));
    CHECK((warp.system == System::warp && warp.beam == 1 && warp.is_periodic && warp.turns[0] == 1 && warp.turns[1] == 0));
    const auto phase = server<PhaseChanged>("phase");
    CHECK((phase.seq == 38 && phase.step == 1100 && phase.phase == Phase::running));
    const auto applied = server<Applied>("applied");
    CHECK((applied.seq == 39 && applied.step == 1180 && std::get<Flip>(applied.change) == Flip{29, 25, true}));
    const auto flipped = server<Flipped>("flipped");
    CHECK((flipped.seq == 40 && flipped.step == 1195 && !flipped.done && !flipped.reason.empty()));
    CHECK(server<Checkpointed>("checkpointed").request == "shoe-4711");
    const auto recovered = server<Recovered>("recovered");
    CHECK((recovered.seq == 42 && recovered.step == 1200 && recovered.frame == 340));
    const auto ended = server<Ended>("ended");
    CHECK((ended.why == Why::failed && ended.step == 1500 && ended.error->code == ErrorCode::system && ended.report.empty()));
}

TEST_CASE("what is not in the protocol is refused, with its place") {
    using Catch::Contains;
    const std::string create = example("client", "create"), run = example("client", "run");
    CHECK_THAT(client_refusal("nonsense"), Contains("message: "));
    CHECK_THAT(client_refusal("[]"), Contains("must be an object"));
    CHECK_THAT(client_refusal("{}"), Contains("type: is missing"));
    CHECK_THAT(client_refusal(with(run, "/type", "layout")), Contains("type: must be one of hello, create"));
    CHECK_THAT(server_refusal(run), Contains("type: must be one of welcome"));
    CHECK_THAT(client_refusal(with(run, "/more", 1)), Contains("more: is not known here"));
    CHECK_THAT(client_refusal(with(create, "/simulation/plan/region/more", 1)), Contains("simulation.plan.region.more: is not known"));
    CHECK_THAT(client_refusal(with(create, "/simulation/plan/region/first_row", -1)), Contains("simulation.plan.region.first_row"));
    CHECK_THAT(client_refusal(with(create, "/simulation/plan/held/0", Json::array({1}))), Contains("simulation.plan.held[0]"));
    CHECK_THAT(client_refusal(with(create, "/simulation/plan/relaxing_N_per_mm", Json::array({1}))), Contains("relaxing_N_per_mm"));
    CHECK_THAT(client_refusal(with(create, "/simulation/solver", nullptr)), Contains("simulation.solver"));
    CHECK_THAT(client_refusal(with(create, "/simulation/residual", 2)), Contains("simulation.residual"));
    CHECK_THAT(client_refusal(with(run, "/request", "short")), Contains("request: must be 8 to 64"));
    CHECK_THAT(client_refusal(with(run, "/request", "Capitals")), Contains("request: must be 8 to 64"));
    CHECK_THAT(client_refusal(with(run, "/request", std::string(65, 'a'))), Contains("request: is longer than 64"));
    CHECK_THAT(client_refusal(with(run, "/session", 0)), Contains("session"));
    CHECK_THAT(client_refusal(with(run, "/session", most_number + 1)), Contains("session"));
    CHECK_THAT(client_refusal(with(run, "/session", 7.5)), Contains("session"));
    CHECK_THAT(client_refusal(with(example("client", "hello"), "/versions/0", 0)), Contains("versions[0]"));
    CHECK_THAT(client_refusal(with(example("client", "frames"), "/most_per_second", 1e9)), Contains("most_per_second"));
    CHECK_THAT(server_refusal(with(example("server", "gap"), "/last", 300)), Contains("last: is before the first"));
    CHECK_THAT(server_refusal(with(example("server", "job_ended"), "/phase", "running")), Contains("phase: is no end"));
    CHECK_THAT(server_refusal(with(example("server", "job_ended"), "/evidence", "signed")), Contains("evidence: must be an object"));
    CHECK_THAT(server_refusal(with(example("server", "jobs"), "/jobs/1/place", 0)), Contains("jobs[1].place"));
    CHECK_THAT(server_refusal(with(example("server", "sessions"), "/sessions/0/points", 0)), Contains("sessions[0].points"));
    CHECK_THAT(server_refusal(with(example("server", "sessions"), "/sessions/0/phase", "done")), Contains("sessions[0].phase"));
    CHECK_THAT(server_refusal(with(example("server", "sessions"), "/sessions", Json(std::vector<Json>(1001, Json(0))))),
               Contains("sessions: has more than 1000 items"));
    CHECK_THAT(server_refusal(with(example("server", "ended"), "/report", 3)), Contains("report: must be an object"));
    CHECK_THAT(server_refusal(with(example("server", "layout"), "/yarns/1/colour", "red")), Contains("yarns[1].colour"));
    CHECK_THAT(server_refusal(with(example("server", "layout"), "/yarns/1/colour", "#D85030")), Contains("yarns[1].colour"));
    CHECK_THAT(server_refusal(with(example("server", "layout"), "/yarns/0/radius_mm", 0)), Contains("yarns[0].radius_mm"));
}

TEST_CASE("a change that is none, or two, or changes nothing, is refused") {
    using Catch::Contains;
    Json change = parse_json(example("client", "change", 3)).value();
    change["pins"] = Json::array();
    CHECK_THAT(client_refusal(change.dump()), Contains("change: is one of"));
    change.erase("pins");
    change.erase("flip");
    CHECK_THAT(client_refusal(change.dump()), Contains("change: is one of"));
    change["parameters"] = {{"warp", Json::object()}, {"weft", Json::object()}};
    CHECK_THAT(client_refusal(change.dump()), Contains("parameters: changes nothing"));
    change.erase("parameters");
    change["pins"] = Json::array();
    CHECK(read_client_message(change.dump()));
}

TEST_CASE("lists beyond their limits are refused before they are read") {
    Json change = parse_json(example("client", "change", 1)).value();
    change["pins"] = Json(std::vector<Json>(65537, Json(0)));
    CHECK_THAT(client_refusal(change.dump()), Catch::Contains("pins: has more than 65536 items"));
    CHECK_THAT(client_refusal(std::string(most_client_bytes + 1, ' ')), Catch::Contains("is longer than"));
    CHECK_THAT(server_refusal(std::string(most_server_bytes + 1, ' ')), Catch::Contains("is longer than"));
}

TEST_CASE("the id of a request is found where the rest is no message") {
    CHECK(request_of(R"({"type":"dance","request":"shoe-4711"})") == "shoe-4711");
    CHECK_FALSE(request_of(R"({"type":"dance","request":"Shoe"})"));
    CHECK_FALSE(request_of(R"({"type":"dance","request":4711})"));
    CHECK_FALSE(request_of(R"(["request"])"));
    CHECK_FALSE(request_of(R"({"request":"shoe-4711")"));
}

TEST_CASE("text that is no UTF-8 is written so that it can be read") {
    Refused refused;
    refused.error = bad_input("what \xff is", "where");
    const auto again = read_server_message(write_message(ServerMessage(refused)));
    REQUIRE(std::get<Refused>(again.value()).error.message == "what \\xff is");
}

TEST_CASE("a message with a random change is refused with its place, or is written as it is read") {
    for_all(
        [](Random& random) {
            const bool from_client = random.coin();
            const auto& lines = examples_of(from_client ? "client" : "server");
            std::string text = lines[random.between(0, lines.size() - 1)];
            for (std::size_t k = random.between(1, 3); k > 0; --k) {
                static const std::string likely = "0123456789-.,:[]{}\"eE atrue";
                text[random.between(0, text.size() - 1)] = likely[random.between(0, likely.size() - 1)];
            }
            INFO(text);
            const auto check = [&](const auto& message, const auto& read) {
                if (!message) {
                    REQUIRE_FALSE(message.error().message.empty());
                    REQUIRE_FALSE(message.error().text() == message.error().message);
                    return;
                }
                const std::string written = write_message(*message);
                REQUIRE(write_message(read(written).value()) == written);
                REQUIRE(canonical_json(parse_json(text).value()) == written);
            };
            if (from_client) check(read_client_message(text), read_client_message);
            else check(read_server_message(text), read_server_message);
        },
        property_cases());
}
