// Sessions on a server: what there are, and the end of one that nobody needs any more.

#include "command.hpp"
#include "on_server.hpp"

#include <weave/core/text.hpp>
#include <weave/wire/remote_job.hpp>

#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

namespace weave::program {

namespace {

using Clock = std::chrono::steady_clock;

/// The end of a session that had ended before is told at once.
constexpr std::chrono::seconds known_end_patience{5};

std::string phase_in_words(const Json& session) {
    if (session.value("ended", false)) return "ended";
    const std::string phase = session.at("phase");
    return phase == "at_rest" ? "at rest" : phase;
}

/// `some 23 h`
std::string roughly(double seconds) {
    constexpr double minute = 60, hour = 3600;
    char text[60];
    if (seconds < 2 * minute) std::snprintf(text, sizeof text, "some %.0f s", seconds);
    else if (seconds < 2 * hour) std::snprintf(text, sizeof text, "some %.0f min", seconds / minute);
    else std::snprintf(text, sizeof text, "some %.0f h", seconds / hour);
    return text;
}

/// Who looks on, and how long it stays where nobody does, as far as the server tells.
std::string viewers_in_words(const Json& session) {
    const auto attached = session.at("attached").get<std::uint64_t>();
    if (attached > 0) return counted(attached, "client") + " attached";
    if (!session.contains("left_s")) return "nobody attached";
    const char* const then = session.value("ended", false) ? "forgotten" : "ended";
    return "nobody attached, " + std::string(then) + " in " + roughly(session.at("left_s"));
}

std::string line_of(const Json& session) {
    return beginning_of(session, "session", phase_in_words(session)) + ", " + counted(session.at("points").get<std::uint64_t>(), "point") + ", " + viewers_in_words(session);
}

Status list(CommandOutcome& outcome, const ServerWish& wish) {
    WEAVE_TRY(wire::Follower follower, server_of(wish));
    auto sessions = wire::answer_of<wire::SessionList>(follower.ask(wire::ListSessions{wire::new_request_id()}, wire::answer_patience));
    if (!sessions) return std::move(sessions).error().in(follower.place().name);
    follower.close();
    return tell_list(outcome, follower, "sessions", std::move(*sessions), line_of);
}

/// The last event of the session that is followed; nothing if it does not come in time.
Result<std::optional<wire::Ended>> end_of_session(wire::Follower& follower, std::chrono::seconds patience) {
    for (const auto until = Clock::now() + patience; Clock::now() < until;) {
        WEAVE_TRY(auto received, follower.receive(std::chrono::seconds(1)));
        auto* message = received ? std::get_if<wire::ServerMessage>(&*received) : nullptr;
        auto* ended = message != nullptr ? std::get_if<wire::Ended>(message) : nullptr;
        if (ended != nullptr) return std::optional(std::move(*ended));
    }
    return std::optional<wire::Ended>();
}

/// Ends it, unless it has ended; its end is dealt with, so the server forgets it.
Result<wire::Ended> closed(wire::Follower& follower, std::uint64_t session) {
    WEAVE_CHECK_OK(follower.attach(session, 0, 0, wire::answer_patience));
    static_cast<void>(follower.ask(wire::WantFrames{wire::new_request_id(), session, 0}, wire::answer_patience));  // one of any size would only keep it busy
    const auto accepted = wire::answer_of<wire::Accepted>(follower.ask(wire::Close{wire::new_request_id(), session}, wire::answer_patience));
    WEAVE_TRY(auto ended, end_of_session(follower, accepted ? wire::answer_patience : known_end_patience));
    if (!ended && !accepted) return accepted.error();
    if (!ended) return system_fault("is to end, and the server does not tell that it has");
    WEAVE_CHECK_OK(follower.acknowledge());
    return std::move(*ended);
}

Status close(CommandOutcome& outcome, const NumberedWish& wish) {
    WEAVE_TRY(wire::Follower follower, server_of(wish.server));
    const std::string name = "session " + std::to_string(wish.number);
    const auto ended = closed(follower, wish.number);
    follower.close();
    if (!ended) return Error{ended.error().code, ended.error().message, follower.place().name + ": " + name};
    constexpr const char* whys[]{"closed", "failed", "expired"};
    const std::string why = whys[static_cast<int>(ended->why)];
    Json answer{{"server", follower.place().name}, {"session", wish.number}, {"why", why}, {"step", ended->step}, {"report", ended->report}};
    std::string words = name + (ended->why == wire::Why::closed ? " is closed" : " had ended (" + why + "), and is forgotten") + ", after " + counted(ended->step, "step") + "\n";
    if (ended->error) words += on_one_line(ended->error->text()) + "\n";
    if (ended->error) answer["reason"] = ended->error->text();
    outcome.answer(answer, words);
    return {};
}

}  // namespace

void add_session_commands(CLI::App& app, CommandOutcome& outcome) {
    const auto wish = std::make_shared<NumberedWish>();
    CLI::App* sessions = add_list_command(app, outcome, wish->server, "sessions", "Your live sessions on a server: list them (--on HOST), or close one",
                                          [=, &outcome] { return list(outcome, wish->server); });
    CLI::App* closing = add_numbered_command(sessions, outcome, *wish, "close", "End a session for all who look on, whose state is gone then; the server forgets it",
                                             "the number of the session");
    on_run(closing, outcome, [=, &outcome] { return close(outcome, *wish); });
}

}  // namespace weave::program
