// Jobs on a server: what there are, their yarns, their end.

#include "command.hpp"
#include "remote_job.hpp"
#include "simulate_ending.hpp"

#include <weave/command/server_wish.hpp>
#include <weave/core/file.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

namespace weave::program {

namespace {

struct Wish {
    ServerWish server;
    std::uint64_t job = 0;
    std::string out, evidence;
};

Result<wire::Follower> server_of(const Wish& wish) {
    if (wish.server.host.empty()) return Error{ErrorCode::usage, "say on which server: --on HOST", ""};
    WEAVE_TRY(const wire::ServerPlace place, place_of(wish.server));
    return connected(place);
}

Result<wire::JobList> jobs_of(wire::Follower& follower) {
    return wire::answer_of<wire::JobList>(follower.ask(wire::ListJobs{wire::new_request_id()}, answer_patience));
}

std::string line_of(const Json& job) {
    const std::string phase = job.at("phase");
    std::string facts;
    char text[100];
    if (job.contains("place")) facts += ", place " + std::to_string(job.at("place").get<std::uint64_t>()) + " in the queue";
    if (job.contains("wait_s")) std::snprintf(text, sizeof text, ", begins in some %.0f s", job.at("wait_s").get<double>()), facts += text;
    if (job.contains("residual")) {
        std::snprintf(text, sizeof text, ", residual %.2e after %llu steps", job.at("residual").get<double>(),
                      static_cast<unsigned long long>(job.at("step").get<std::uint64_t>()));
        facts += text;
    }
    if (job.contains("left_s")) std::snprintf(text, sizeof text, ", to go some %.0f s", job.at("left_s").get<double>()), facts += text;
    return std::to_string(job.at("job").get<std::uint64_t>()) + "  " + on_one_line(job.at("title").get<std::string>()) + ": " + phase + facts + "\n";
}

Status list(CommandOutcome& outcome, const Wish& wish) {
    WEAVE_TRY(wire::Follower follower, server_of(wish));
    WEAVE_TRY(wire::JobList jobs, jobs_of(follower));
    follower.close();
    WEAVE_TRY(Json told, parse_json(wire::write_message(wire::ServerMessage(std::move(jobs)))));
    std::string words = told.at("jobs").empty() ? "no jobs\n" : "";
    for (const Json& job : told.at("jobs")) words += line_of(job);
    outcome.answer({{"server", follower.place().name}, {"jobs", told.at("jobs")}}, words);
    return {};
}

/// The end of a job that has ended, which every connection is told of.
Result<wire::JobEnded> end_of(wire::Follower& follower, std::uint64_t job) {
    const std::string where = follower.place().name + ": " + name_of(job);
    WEAVE_TRY(const wire::JobList jobs, jobs_of(follower));
    const auto state = std::ranges::find(jobs.jobs, job, &wire::JobState::job);
    if (state == jobs.jobs.end()) return Error{ErrorCode::refused, "there is no such job, or its end was dealt with", where};
    if (state->phase < wire::JobPhase::done) return Error{ErrorCode::refused, "has not ended yet", where};
    const auto until = std::chrono::steady_clock::now() + answer_patience;
    while (std::chrono::steady_clock::now() < until) {
        WEAVE_TRY(auto received, follower.receive(std::chrono::seconds(1)));
        auto* message = received ? std::get_if<wire::ServerMessage>(&*received) : nullptr;
        auto* ended = message != nullptr ? std::get_if<wire::JobEnded>(message) : nullptr;
        if (ended != nullptr && ended->job == job) return std::move(*ended);
    }
    return system_fault("the server does not tell how it ended", where);
}

Status fetch(CommandOutcome& outcome, const Wish& wish) {
    WEAVE_CHECK_OK(keep_apart(wish.evidence, wish.out, "the file for the yarns (-o)"));
    WEAVE_CHECK_OK(keep_apart(wish.out, wish.server.token_file, "the file of the token"));
    WEAVE_TRY(wire::Follower follower, server_of(wish));
    WEAVE_TRY(const wire::JobEnded ended, end_of(follower, wish.job));
    if (has_yarns(ended)) {
        WEAVE_TRY(const RemoteYarns fetched, fetch_yarns(follower, ended));
        std::optional<std::string> evidence;
        if (!wish.evidence.empty()) {
            WEAVE_TRY(evidence, fetch_evidence(follower, ended));
        }
        WEAVE_CHECK_OK(write_file(wish.out, fetched.bytes));
        if (evidence) WEAVE_CHECK_OK(write_file(wish.evidence, *evidence));
    }
    WEAVE_CHECK_OK(follower.acknowledge_job(wish.job, answer_patience));
    follower.close();
    if (!has_yarns(ended)) return reason_of(ended);
    Json answer = ended.report;
    const auto undone = left_undone(answer, {answer.value("flips", Json::array()).size(), 0, false});
    if (!undone.empty()) answer["left_undone"] = undone;
    const Json report = answer;
    answer["file"] = wish.out;
    answer["job"] = wish.job;
    answer["server"] = follower.place().name;
    const Design none;
    return tell_ending(outcome, report, std::move(answer), {none, {}, ""});
}

Status cancel(CommandOutcome& outcome, const Wish& wish) {
    WEAVE_TRY(wire::Follower follower, server_of(wish));
    const auto accepted = wire::answer_of<wire::Accepted>(follower.ask(wire::Cancel{wire::new_request_id(), wish.job}, answer_patience));
    follower.close();
    if (!accepted) return Error{accepted.error()}.in(follower.place().name + ": " + name_of(wish.job));
    outcome.answer({{"server", follower.place().name}, {"job", wish.job}}, name_of(wish.job) + " is cancelled; weave jobs fetch gets its yarns as they lay, if it had begun\n");
    return {};
}

CLI::App* add_job_command(CLI::App* jobs, CommandOutcome& outcome, const std::shared_ptr<Wish>& wish, const std::string& name, const std::string& help) {
    CLI::App* command = add_command(*jobs, outcome, name, help);
    command->add_option("N", wish->job, "the number of the job")->transform(between(std::int64_t{1}, static_cast<std::int64_t>(wire::most_number)))->required();
    add_server_options(command, wish->server);
    return command;
}

}  // namespace

void add_job_commands(CLI::App& app, CommandOutcome& outcome) {
    const auto wish = std::make_shared<Wish>();
    CLI::App* jobs = add_command(app, outcome, "jobs", "Your jobs on a server: list them (--on HOST), fetch or cancel one");
    add_server_options(jobs, wish->server);
    on_run(jobs, outcome, [=, &outcome] { return jobs->get_subcommands().empty() ? list(outcome, *wish) : Status(); });
    CLI::App* fetching = add_job_command(jobs, outcome, wish, "fetch", "Fetch the yarns of a job that has ended; then the server forgets it (exit 1: as weave simulate)");
    fetching->add_option("-o,--out", wish->out, "the .yarns file to write")->type_name("FILE")->required()->check(output_name());
    fetching->add_option("--evidence", wish->evidence, "the file for what the server signed of it")->type_name("FILE");
    on_run(fetching, outcome, [=, &outcome] { return fetch(outcome, *wish); });
    CLI::App* cancelling = add_job_command(jobs, outcome, wish, "cancel", "End a job; one that had begun keeps its yarns as they lay");
    on_run(cancelling, outcome, [=, &outcome] { return cancel(outcome, *wish); });
}

}  // namespace weave::program
