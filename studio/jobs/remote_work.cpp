#include <studio/jobs/remote_work.hpp>

#include <weave/core/text.hpp>
#include <weave/design/document.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/sim/yarns_file.hpp>
#include <weave/wire/server_room.hpp>

#include <algorithm>
#include <studio/jobs/plan_summary.hpp>
#include <type_traits>
#include <utility>

namespace weave::studio {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// How long a session may take to be planned and admitted; how soon the window's wishes are looked at; how
/// long one question waits before the window is looked at again; what a run that is left may take to say so, and to
/// come to a stand.
constexpr std::chrono::minutes creation{5};
constexpr std::chrono::milliseconds look{15}, question{500}, farewell{2000}, standstill{10'000};
/// A refusal that says so is waited for, when it is short.
constexpr double longest_wait_s = 30;
constexpr std::uint64_t most_yarns_bytes = std::uint64_t{8} << 30;

wire::Simulation simulation_of(const sim::RunRequest& request) {
    wire::Simulation simulation;
    simulation.plan = request.plan;
    simulation.solver = request.goal.solver;
    simulation.residual = request.goal.residual;
    if (request.goal.most_iterations < wire::most_number)
        simulation.most_steps = request.goal.most_iterations;
    if (request.goal.most_seconds < 1e9) simulation.most_seconds = request.goal.most_seconds;
    simulation.start_from = request.start_from;
    return simulation;
}

double goal_of(const sim::RunRequest& request, bool is_coarse) {
    if (is_coarse && request.start_from) return sim::goal_of(*request.start_from);
    return request.goal.residual.value_or(sim::goal_of(request.plan.fidelity));
}

RunPhase shown(wire::Phase phase) {
    switch (phase) {
        case wire::Phase::running:
            return RunPhase::running;
        case wire::Phase::at_rest:
            return RunPhase::at_rest;
        case wire::Phase::paused:
            break;
    }
    return RunPhase::paused;
}

/// What a server says, on one line.
Error plain(Error error) {
    error.message = on_one_line(error.message);
    error.where = on_one_line(error.where);
    return error;
}

}  // namespace

RemoteWork::RemoteWork(Design design, sim::RunRequest request, ServerWish server, Inbox& inbox,
                       Outbox& outbox)
    : m_design(std::move(design)),
      m_request(std::move(request)),
      m_server(std::move(server)),
      m_inbox(inbox),
      m_outbox(outbox) {}

void RemoteWork::run(std::chrono::milliseconds patience) {
    Status done = begin(patience);
    if (done) done = loop();
    if (!done) return m_outbox.tell(plain(std::move(done).error()));
    finish();
}

/// The plan is made here too: what is wrong with a design, and that the server can never have room for it, shows before
/// anything is sent, and what is modelled can be told. Whether it has room just now, the server itself says.
Status RemoteWork::begin(std::chrono::milliseconds patience) {
    WEAVE_TRY(const wire::ServerPlace place, place_of(m_server));
    WEAVE_TRY(const Evaluation evaluation, evaluate(m_design));
    const auto room = wire::room_on(place);
    const auto foreseen = sim::foreseen_need(m_design, *evaluation.block, m_request.plan);
    if (room && foreseen) WEAVE_CHECK_OK(sim::check_room(*foreseen, *room));
    WEAVE_TRY(const sim::Plan plan, make_plan(m_design, *evaluation.block, m_request.plan));
    m_outbox.tell(std::make_shared<const PlanSummary>(summary_of(plan, m_design.title)));
    if (room) WEAVE_CHECK_OK(sim::check_room(sim::need_of(plan), *room));
    if (m_inbox.finish() != Finish::no) return {};
    WEAVE_TRY(m_follower, wire::Follower::connect(place, "weave studio", patience));
    m_follower->on_trouble([this](const Error* trouble) {
        tell_trouble(trouble != nullptr ? plain(*trouble).text() : std::string());
    });
    WEAVE_TRY(const wire::Accepted accepted,
              m_follower->create(write_document(m_design), simulation_of(m_request), creation));
    m_session = accepted.session.value_or(0);
    m_meter.aim_at(goal_of(m_request, m_request.start_from.has_value()));
    return {};
}

Status RemoteWork::loop() {
    while (!m_is_over && m_inbox.finish() == Finish::no) {
        WEAVE_CHECK_OK(send_orders());
        WEAVE_CHECK_OK(take_news(look));
        fetch_yarns();
    }
    return {};
}

/// The session is closed, so that its server has the room for others; one that cannot be reached closes it by
/// itself in time.
void RemoteWork::finish() {
    if (m_session == 0) return;
    const bool wants_yarns = m_inbox.finish() == Finish::report;
    if (wants_yarns && !m_is_over) {
        const bool stands = bring_to_stand();
        m_outbox.tell(m_meter.take());
        if (stands && m_meter.step() > 0) static_cast<void>(fetch_yarns_now());
    }
    if (!m_is_over && !m_follower->trouble())
        static_cast<void>(m_follower->ask(wire::Close{wire::new_request_id(), m_session}, farewell));
    const auto end = Clock::now() + farewell;
    while (!m_is_over && Clock::now() < end && !m_follower->trouble() && take_news(look)) {
    }
    static_cast<void>(m_follower->acknowledge());
    m_follower->close();
    if (wants_yarns) m_outbox.tell(RunPhase::stopped);
}

/// Within a step, where the server does as it is asked; one that does not is not waited for.
bool RemoteWork::bring_to_stand() {
    const auto end = Clock::now() + standstill;
    const auto answer = m_follower->ask(wire::Pause{wire::new_request_id(), m_session}, farewell);
    const bool is_taken = answer && !std::holds_alternative<wire::Refused>(*answer);
    while (is_taken && is_heard() && m_phase == wire::Phase::running && Clock::now() < end) {
        if (!take_news(look)) return false;
    }
    return is_heard() && m_phase != wire::Phase::running;
}

/// Whether there is somebody to listen, and somebody who wants to know.
bool RemoteWork::is_heard() const {
    return !m_is_over && m_inbox.finish() != Finish::leave && !m_follower->trouble();
}

// ---- What is asked ----

Status RemoteWork::send_orders() {
    for (const Order& order : m_inbox.take()) {
        if (m_inbox.finish() != Finish::no || m_is_over) return {};
        WEAVE_CHECK_OK(send(order));
    }
    return {};
}

wire::ClientMessage RemoteWork::message_of(const Order& order, const std::string& request) const {
    return std::visit(
        [&](const auto& one) -> wire::ClientMessage {
            using One = std::decay_t<decltype(one)>;
            if constexpr (std::is_same_v<One, RunOrder>)
                return wire::Run{request, m_session};
            else if constexpr (std::is_same_v<One, PauseOrder>)
                return wire::Pause{request, m_session};
            else if constexpr (std::is_same_v<One, StepOrder>)
                return wire::Step{request, m_session, one.steps};
            else
                return wire::MakeChange{request, m_session, one};
        },
        order);
}

Status RemoteWork::send(const Order& order) {
    const std::string request = wire::new_request_id();
    if (const auto* flip = std::get_if<Flip>(&order)) m_flips[request] = *flip;
    const wire::ClientMessage message = message_of(order, request);
    while (true) {
        auto answer = ask(message);
        if (!answer) {
            if (answer.error().code != ErrorCode::usage) return std::move(answer).error();
            return refuse(order, {request, std::move(answer).error(), {}});  // a message that no server takes
        }
        if (!*answer) return {};
        const auto* refused = std::get_if<wire::Refused>(&**answer);
        if (refused == nullptr) return {};
        if (!refused->wait_s || *refused->wait_s > longest_wait_s) return refuse(order, *refused);
        WEAVE_CHECK_OK(
            take_news(std::chrono::milliseconds(static_cast<std::int64_t>(1000 * *refused->wait_s) + 1)));
        if (m_inbox.finish() != Finish::no || m_is_over) return {};
    }
}

/// What a server does not do does not end the run.
Status RemoteWork::refuse(const Order& order, const wire::Refused& refused) {
    std::erase_if(m_flips, [&](const auto& flip) { return flip.first == refused.request; });
    const Error error = plain(refused.error);
    if (const auto* flip = std::get_if<Flip>(&order))
        m_outbox.tell(FlipEnd{*flip, false, error.text()});
    else
        m_outbox.tell(ChangeRefused{error});
    return {};
}

/// A question is put under one id until it is answered, which does it once.
Result<std::optional<wire::ServerMessage>> RemoteWork::ask(const wire::ClientMessage& message) {
    while (m_inbox.finish() == Finish::no && !m_is_over) {
        auto answer = m_follower->ask(message, question);
        if (answer) return std::optional(std::move(*answer));
        if (answer.error().code != ErrorCode::system) return std::move(answer).error();
        WEAVE_CHECK_OK(take_news(0ms));  // fails where it has given up for good
    }
    return std::optional<wire::ServerMessage>();
}

// ---- What comes ----

Status RemoteWork::take_news(std::chrono::milliseconds most) {
    const auto end = Clock::now() + most;
    do {
        const auto left =
            std::max(0ms, std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()));
        WEAVE_TRY(auto received, m_follower->receive(left));
        if (!received) return {};
        if (auto* frame = std::get_if<wire::Frame>(&*received))
            take(std::move(*frame));
        else
            WEAVE_CHECK_OK(take(std::get<wire::ServerMessage>(*received)));
    } while (Clock::now() < end && !m_is_over && m_inbox.finish() != Finish::leave);
    return {};
}

Status RemoteWork::take(const wire::ServerMessage& message) {
    if (const auto* layout = std::get_if<wire::Layout>(&message))
        m_outbox.tell(std::make_shared<const YarnLayout>(*layout));
    if (const auto* changed = std::get_if<wire::PhaseChanged>(&message)) take(*changed);
    if (const auto* applied = std::get_if<wire::Applied>(&message)) take(*applied);
    if (const auto* flipped = std::get_if<wire::Flipped>(&message)) take(*flipped);
    if (const auto* recovered = std::get_if<wire::Recovered>(&message)) take(*recovered);
    if (const auto* ended = std::get_if<wire::Ended>(&message)) return take(*ended);
    return {};
}

void RemoteWork::take(const wire::PhaseChanged& changed) {
    m_phase = changed.phase;
    if (m_phase == wire::Phase::running)
        m_meter.go_on();
    else
        m_meter.stand();
    m_outbox.tell(shown(m_phase));
    m_wants_yarns = m_phase != wire::Phase::running && changed.step > 0;
    m_next_fetch = {};
    if (m_phase == wire::Phase::at_rest && std::exchange(m_leads, false)) m_outbox.tell(ParametersArrived{});
}

void RemoteWork::take(const wire::Applied& applied) {
    if (applied.error) return m_outbox.tell(ChangeRefused{plain(*applied.error)});
    m_leads = m_leads || std::holds_alternative<wire::Parameters>(applied.change);
}

void RemoteWork::take(const wire::Flipped& flipped) {
    const auto found = m_flips.find(flipped.request);
    if (found == m_flips.end()) return;
    m_outbox.tell(FlipEnd{found->second, flipped.done, on_one_line(flipped.reason)});
    m_flips.erase(found);
}

void RemoteWork::take(const wire::Recovered& recovered) {
    tell_trouble("the server had a fault and goes on from step " + std::to_string(recovered.step));
}

Status RemoteWork::take(const wire::Ended& ended) {
    m_is_over = true;
    switch (ended.why) {
        case wire::Why::closed:
            if (m_inbox.finish() != Finish::no) return {};
            return Error{ErrorCode::refused, "the session was closed elsewhere", m_follower->place().name};
        case wire::Why::expired:
            return Error{ErrorCode::refused,
                         "the server ended the session, as nobody had been connected for long",
                         m_follower->place().name};
        case wire::Why::failed:
            break;
    }
    return ended.error.value_or(system_fault("the session ended without a reason", m_follower->place().name));
}

void RemoteWork::take(wire::Frame frame) {
    if (m_follower && !m_follower->trouble()) tell_trouble({});
    m_meter.aim_at(goal_of(m_request, frame.head.is_coarse));
    m_meter.see_coarse(frame.head.is_coarse);
    m_meter.see_flip(frame.head.is_flipping);
    if (frame.head.lost_crossings) m_meter.see_lost(*frame.head.lost_crossings);
    m_meter.pass_step(frame.head.step, frame.head.residual);
    m_outbox.tell(m_meter.take());
    m_outbox.tell(std::make_shared<const Frame>(std::move(frame)));
}

void RemoteWork::tell_trouble(std::string words) {
    if (m_trouble == words) return;
    m_trouble = std::move(words);
    m_outbox.tell(Trouble{m_trouble});
}

// ---- Yarns ----

/// While it stands: as it lies, exactly. What fails with the connection is tried again.
void RemoteWork::fetch_yarns() {
    if (!m_wants_yarns || m_is_over || m_follower->trouble() || Clock::now() < m_next_fetch) return;
    m_next_fetch = Clock::now() + 1s;
    if (fetch_yarns_now()) m_wants_yarns = false;
}

bool RemoteWork::fetch_yarns_now() {
    const auto bytes = wire::download(m_follower->place(), wire::session_yarns(m_session), most_yarns_bytes);
    if (!bytes && bytes.error().code == ErrorCode::system) return false;
    auto read = bytes ? read_yarns(*bytes) : Result<Yarns>(bytes.error());
    if (!read) {
        m_outbox.tell(ChangeRefused{plain(std::move(read).error().in(m_follower->place().name))});
        return true;
    }
    const auto yarns = std::make_shared<const Yarns>(std::move(*read));
    m_outbox.tell(yarns);
    if (m_phase != wire::Phase::at_rest) return true;
    if (auto inspection = inspect(*yarns))
        m_outbox.tell(Inspected{yarns, std::make_shared<const Inspection>(std::move(*inspection))});
    return true;
}

}  // namespace weave::studio
