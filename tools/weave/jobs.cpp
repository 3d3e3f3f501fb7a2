// Jobs on a server: what there are, their yarns, their end.

#include "command.hpp"
#include "on_server.hpp"
#include "remote_job.hpp"
#include "simulate_ending.hpp"
#include "simulate_wish.hpp"

#include <weave/core/file.hpp>
#include <weave/design/document.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <utility>

namespace weave::program {

namespace {

using namespace std::chrono_literals;

/// How long a person who cancels a job waits for its worker to put away what it has.
constexpr auto cancel_patience = 15s;

struct Wish : NumberedWish {
    std::string out, evidence;
    std::string design, save_design;  ///< what the job was made of; where it goes with the flips that were made
};

std::string line_of(const Json& job) {
    std::string facts;
    char text[100];
    if (job.contains("place")) facts += ", place " + std::to_string(job.at("place").get<std::uint64_t>()) + " in the queue";
    if (job.contains("wait_s")) std::snprintf(text, sizeof text, ", begins in some %.0f s", job.at("wait_s").get<double>()), facts += text;
    if (job.contains("left_s")) std::snprintf(text, sizeof text, ", to go some %.0f s", job.at("left_s").get<double>()), facts += text;
    if (job.contains("batch")) facts += "; " + on_one_line(job.at("batch").get<std::string>());
    return beginning_of(job, "job", job.at("phase").get<std::string>()) + facts;
}

/// The end of a job, which every connection is told of, where it comes in time.
Result<std::optional<wire::JobEnded>> told_end(wire::Follower& follower, std::uint64_t job, std::chrono::milliseconds patience) {
    const auto until = std::chrono::steady_clock::now() + patience;
    while (std::chrono::steady_clock::now() < until) {
        WEAVE_TRY(auto received, follower.receive(std::min<std::chrono::milliseconds>(patience, std::chrono::seconds(1))));
        auto* message = received ? std::get_if<wire::ServerMessage>(&*received) : nullptr;
        auto* ended = message != nullptr ? std::get_if<wire::JobEnded>(message) : nullptr;
        if (ended != nullptr && ended->job == job) return std::optional(std::move(*ended));
    }
    return std::optional<wire::JobEnded>();
}

/// Why jobs failed, which every connection is told at its beginning.
std::map<std::uint64_t, std::string> reasons_of(wire::Follower& follower, const wire::JobList& jobs) {
    auto left = std::ranges::count(jobs.jobs, wire::JobPhase::failed, &wire::JobState::phase);
    std::map<std::uint64_t, std::string> reasons;
    while (left > 0) {
        const auto received = follower.receive(2s);
        if (!received || !*received) break;
        const auto* message = std::get_if<wire::ServerMessage>(&**received);
        const auto* ended = message != nullptr ? std::get_if<wire::JobEnded>(message) : nullptr;
        if (ended == nullptr || ended->phase != wire::JobPhase::failed) continue;
        if (ended->error) reasons[ended->job] = ended->error->text();
        --left;
    }
    return reasons;
}

Status list(CommandOutcome& outcome, const ServerWish& wish) {
    WEAVE_TRY(wire::Follower follower, server_of(wish));
    WEAVE_TRY(wire::JobList jobs, wire::jobs_of(follower));
    const std::map<std::uint64_t, std::string> reasons = reasons_of(follower, jobs);
    follower.close();
    return tell_list(outcome, follower, "jobs", std::move(jobs), [&](const Json& job) {
        const auto reason = reasons.find(job.at("job").get<std::uint64_t>());
        return line_of(job) + (reason == reasons.end() ? "" : ": " + on_one_line(reason->second));
    });
}

/// The end of a job that has ended.
Result<wire::JobEnded> end_of(wire::Follower& follower, std::uint64_t job) {
    const std::string where = follower.place().name + ": " + wire::name_of(job);
    WEAVE_TRY(const wire::JobList jobs, wire::jobs_of(follower));
    const auto state = std::ranges::find(jobs.jobs, job, &wire::JobState::job);
    if (state == jobs.jobs.end()) return Error{ErrorCode::refused, "there is no such job, or its end was dealt with", where};
    if (state->phase < wire::JobPhase::done) return Error{ErrorCode::refused, "has not ended yet: weave jobs lists how far it is", where};
    WEAVE_TRY(auto ended, told_end(follower, job, wire::answer_patience));
    if (!ended) return system_fault("the server does not tell how it ended", where);
    return std::move(*ended);
}

/// What is read or written besides is not written over; the design may get its flips in place.
Status check_files(const Wish& wish) {
    WEAVE_CHECK_OK(keep_apart(wish.evidence, wish.out, "the file for the yarns (-o)"));
    WEAVE_CHECK_OK(keep_apart(wish.save_design, wish.out, "the file for the yarns (-o)"));
    WEAVE_CHECK_OK(keep_apart(wish.evidence, wish.save_design, "the design that is written"));
    for (const std::string& file : {wish.out, wish.evidence}) WEAVE_CHECK_OK(keep_apart(file, wish.design, "the design that is read"));
    for (const std::string& file : {wish.out, wish.evidence, wish.save_design}) WEAVE_CHECK_OK(keep_apart(file, wish.server.token_file, "the file of the token"));
    return check_outputs({wish.out, wish.evidence, wish.save_design});
}

/// The flips that a report tells of, where the job was given any.
Result<std::vector<Flip>> flips_of(const Json& report, const std::string& where) {
    std::vector<Flip> flips;
    for (const Json& told : report.value("flips", Json::array())) {
        const auto number = [&](const char* name) { return told.contains(name) && told.at(name).is_number_unsigned() ? told.at(name).get<std::size_t>() : 0; };
        if (number("pick") == 0 || number("end") == 0 || !told.contains("weft_over") || !told.at("weft_over").is_boolean())
            return bad_input("its report does not tell its flips as this program knows them", where);
        flips.push_back({number("pick") - 1, number("end") - 1, told.at("weft_over").get<bool>()});
    }
    return flips;
}

/// The design that the job was made of, which with the flips that were made is the one of its yarns.
Result<FlippedDesign> design_of(const Design& design, const Wish& wish, const wire::JobEnded& ended, const Yarns& yarns, const std::string& server) {
    if (wish.save_design.empty()) return FlippedDesign{design, {}, ""};
    WEAVE_TRY(const std::vector<Flip> flips, flips_of(ended.report, server + ": " + wire::name_of(ended.job)));
    if (flips.empty()) return usage_error("without flips the design stays as it is, and " + wire::name_of(ended.job) + " was given none", "--save-design " + wish.save_design);
    const auto made = with_flips_made(design, flips, ended.report);
    if (!made || design_sha256(*made) != yarns.design_sha256)
        return bad_input("is not the design that " + wire::name_of(ended.job) + " was made of: with the flips that were made it is another than that of its yarns (SHA-256)", wish.design);
    return FlippedDesign{design, flips, wish.save_design};
}

/// The files that a job leaves, and how it ended.
Status keep(CommandOutcome& outcome, wire::Follower& follower, const wire::JobEnded& ended, const Design& design, const Wish& wish) {
    const std::string& server = follower.place().name;
    WEAVE_TRY(const RemoteYarns fetched, fetch_yarns(follower, ended));
    WEAVE_TRY(const FlippedDesign flipped, design_of(design, wish, ended, fetched.yarns, server));
    std::optional<wire::RemoteEvidence> evidence;
    if (!wish.evidence.empty()) {
        WEAVE_TRY(evidence, wire::fetch_evidence(follower, ended));
    }
    WEAVE_CHECK_OK(write_file(wish.out, fetched.bytes));
    if (evidence) WEAVE_CHECK_OK(write_file(wish.evidence, evidence->bytes));
    Json report = ended.report;
    const auto undone = left_undone(report, {report.value("flips", Json::array()).size(), 0, false});
    if (!undone.empty()) report["left_undone"] = undone;
    Json answer = report;
    answer["file"] = wish.out;
    answer["job"] = wish.number;
    answer["server"] = server;
    return tell_ending(outcome, report, std::move(answer), flipped);
}

Status fetch(CommandOutcome& outcome, const Wish& wish) {
    WEAVE_CHECK_OK(check_files(wish));
    Design design;
    if (!wish.design.empty()) {
        WEAVE_TRY(design, load_design(wish.design));
    }
    WEAVE_TRY(wire::Follower follower, server_of(wish.server));
    WEAVE_TRY(const wire::JobEnded ended, end_of(follower, wish.number));
    if (wire::has_yarns(ended)) WEAVE_CHECK_OK(keep(outcome, follower, ended, design, wish));
    settle(outcome, follower, wish.number);
    return wire::has_yarns(ended) ? Status() : Status(wire::reason_of(ended));
}

std::string how_cancelled(const wire::JobEnded& ended) {
    if (ended.phase != wire::JobPhase::cancelled) return " had ended meanwhile; weave jobs fetch gets what came of it";
    if (wire::has_yarns(ended)) return " is cancelled; weave jobs fetch gets its yarns as they lay";
    if (ended.error) return " is cancelled, without its yarns: " + on_one_line(ended.error->text());
    return " is cancelled; it had not begun, so there are no yarns";
}

Status cancel(CommandOutcome& outcome, const NumberedWish& wish) {
    WEAVE_TRY(wire::Follower follower, server_of(wish.server));
    const auto accepted = wire::answer_of<wire::Accepted>(follower.ask(wire::Cancel{wire::new_request_id(), wish.number}, wire::answer_patience));
    if (!accepted) return Error{accepted.error().code, accepted.error().message, follower.place().name + ": " + wire::name_of(wish.number)};
    auto ended = told_end(follower, wish.number, 1s);
    if (ended && !*ended) {
        outcome.note(wire::name_of(wish.number) + " puts away what it has ...");
        ended = told_end(follower, wish.number, cancel_patience);
    }
    follower.close();
    Json answer{{"server", follower.place().name}, {"job", wish.number}, {"ended", ended && *ended}};
    std::string how = " is being cancelled; weave jobs lists when it has ended";
    if (ended && *ended) {
        answer["yarns"] = wire::has_yarns(**ended);
        how = how_cancelled(**ended);
    }
    outcome.answer(answer, wire::name_of(wish.number) + how + "\n");
    return {};
}

}  // namespace

void add_job_commands(CLI::App& app, CommandOutcome& outcome) {
    const auto wish = std::make_shared<Wish>();
    CLI::App* jobs = add_list_command(app, outcome, wish->server, "jobs", "Your jobs on a server: list them (--on HOST), fetch or cancel one",
                                      [=, &outcome] { return list(outcome, wish->server); });
    const auto add = [&](const std::string& name, const std::string& help) { return add_numbered_command(jobs, outcome, *wish, name, help, "the number of the job"); };
    CLI::App* fetching = add("fetch", "Fetch the yarns of a job that has ended; then the server forgets it (exit 1: as weave simulate)");
    fetching->add_option("-o,--out", wish->out, "the .yarns file to write")->type_name("FILE")->required()->check(output_name());
    fetching->add_option("--evidence", wish->evidence, "the file for what the server signed of it")->type_name("FILE");
    CLI::Option* of = fetching->add_option("--of", wish->design, "the .weave file that the job was made of, for --save-design")->type_name("FILE");
    fetching->add_option("--save-design", wish->save_design, "the .weave file to write: that design with the flips that were made, if any was")
        ->needs(of)
        ->type_name("FILE")
        ->check(output_name());
    of->needs(fetching->get_option("--save-design"));
    on_run(fetching, outcome, [=, &outcome] { return fetch(outcome, *wish); });
    CLI::App* cancelling = add("cancel", "End a job; one that had begun keeps its yarns as they lay");
    on_run(cancelling, outcome, [=, &outcome] { return cancel(outcome, *wish); });
}

}  // namespace weave::program
