#include "simulate_on.hpp"

#include "interrupt.hpp"
#include "remote_job.hpp"
#include "simulate_ending.hpp"
#include "teller.hpp"

#include <weave/core/exit_code.hpp>
#include <weave/core/file.hpp>
#include <weave/core/text.hpp>
#include <weave/design/document.hpp>

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>
#include <variant>

namespace weave::program {

namespace {

/// The run as a server takes it: its design with the scene of this run, and how it is simulated.
Result<wire::Submit> order_of(const SimulateTask& task, const SimulateWish& wish) {
    wire::Submit submit{wire::new_request_id(), write_document(task.design), {}, task.flips};
    submit.simulation.plan = task.request;
    submit.simulation.solver = task.options.solver;
    submit.simulation.residual = task.options.residual;
    submit.simulation.most_steps = task.options.most_iterations;
    submit.simulation.most_seconds = wish.seconds;
    if (const std::string first = first_points(wish); !first.empty()) {
        WEAVE_TRY(submit.simulation.start_from, sim::parse_fidelity(first));
    }
    return submit;
}

/// An error that leaves the job on the server, with the way to it.
Error kept(Error error, std::uint64_t job, const SimulateWish& wish) {
    error.message += "; the job is kept: weave jobs fetch " + std::to_string(job) + " --on " + wish.server.host;
    return error;
}

/// Tells, as long as it lives, of connections that break and come back.
class TroubleNotes {
  public:
    TroubleNotes(wire::Follower& follower, Teller& teller) : m_follower(follower) {
        follower.on_trouble([&teller, name = follower.place().name](const Error* trouble) {
            teller.note(trouble != nullptr ? trouble->text() + "; trying again" : name + ": connected again");
        });
    }
    ~TroubleNotes() { m_follower.on_trouble({}); }
    TroubleNotes(const TroubleNotes&) = delete;
    TroubleNotes& operator=(const TroubleNotes&) = delete;

  private:
    wire::Follower& m_follower;
};

/// Whether these are yarns of what was asked for.
Status check_yarns(const RemoteYarns& fetched, const wire::JobEnded& ended, const SimulateTask& task) {
    const Yarns& yarns = fetched.yarns;
    WEAVE_TRY(const Design woven, with_flips_made(task.design, task.flips, ended.report));
    const bool same = yarns.scene_sha256 == scene_sha256(task.design) && yarns.design_sha256 == design_sha256(woven);
    const bool all_flips = ended.report.value("flips", Json::array()).size() == task.flips.size();
    if (!same || !all_flips) return bad_input("the server gives yarns of something else than was asked for", wire::name_of(ended.job));
    return {};
}

/// The files that a job leaves; the job can be fetched again if it fails.
Status keep_files(wire::Follower& follower, const wire::JobEnded& ended, const SimulateTask& task, const SimulateWish& wish) {
    WEAVE_TRY(const RemoteYarns fetched, fetch_yarns(follower, ended));
    WEAVE_CHECK_OK(check_yarns(fetched, ended, task));
    std::optional<wire::RemoteEvidence> evidence;
    if (!wish.evidence.empty() && ended.evidence) {
        WEAVE_TRY(evidence, wire::fetch_evidence(follower, ended));
    }
    WEAVE_CHECK_OK(write_file(wish.out, fetched.bytes));
    return evidence ? write_file(wish.evidence, evidence->bytes) : Status();
}

/// The report as a run on this machine tells it.
Json report_of(const wire::JobEnded& ended, const SimulateTask& task) {
    Json report = ended.report;
    const std::vector<std::string> undone = left_undone(report, {task.flips.size(), 0, false});
    if (!undone.empty()) report["left_undone"] = undone;
    if (!undone.empty() && ended.phase == wire::JobPhase::cancelled) report["interrupted"] = true;
    return report;
}

}  // namespace

namespace {

/// The number of the job that was made. A server that is asked for many in a short time says when it takes the next.
Result<std::uint64_t> submitted(wire::Follower& follower, const wire::Submit& order) {
    constexpr int most_tries = 100;
    for (int k = 0; k < most_tries && !interrupted(); ++k) {
        auto answer = follower.ask(order, wire::answer_patience);
        const auto* refused = answer ? std::get_if<wire::Refused>(&*answer) : nullptr;
        if (refused != nullptr && refused->wait_s) {
            constexpr double longest_s = 60;
            std::this_thread::sleep_for(std::chrono::duration<double>(std::min(*refused->wait_s, longest_s)));
            continue;
        }
        WEAVE_TRY(const wire::Accepted accepted, wire::answer_of<wire::Accepted>(std::move(answer)));
        if (!accepted.job) return bad_input("the server gives the job no number", follower.place().name);
        return *accepted.job;
    }
    return Error{ErrorCode::refused, interrupted() ? "was broken off" : "the server has too much to do", follower.place().name};
}

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
    return text;
}

}  // namespace

Status sweep_on(CommandOutcome& outcome, wire::Follower& follower, const std::vector<SimulateTask>& tasks, const std::vector<std::vector<std::string>>& settings,
                const SimulateWish& wish) {
    const HeldInterrupt held("no more jobs are handed over; those that were go on");
    Json jobs = Json::array();
    std::string words;
    std::optional<Error> trouble;
    for (std::size_t k = 0; k < tasks.size() && !trouble; ++k) {
        WEAVE_TRY(const wire::Submit order, order_of(tasks[k], wish));
        const auto job = submitted(follower, order);
        if (!job) {
            trouble = job.error();
            break;
        }
        jobs.push_back({{"job", *job}, {"set", settings[k]}});
        words += std::to_string(*job) + "  " + joined(settings[k]) + "\n";
    }
    follower.close();
    const std::size_t made = jobs.size();
    if (trouble && made == 0) return *trouble;
    Json answer{{"server", follower.place().name}, {"jobs", std::move(jobs)}};
    if (trouble) {
        trouble->message += "; " + counted(made, "job") + " of " + std::to_string(tasks.size()) + " were handed over before";
        answer["error"] = error_json(*trouble);
    }
    outcome.answer(answer, words);
    return trouble ? Status(*trouble) : Status();
}

Status simulate_on(CommandOutcome& outcome, wire::Follower& follower, const Design& design, const SimulateTask& task, const SimulateWish& wish,
                   double goal) {
    const HeldInterrupt held("the job is cancelled, and its yarns are fetched as they lie; again to end at once, and the job goes on");
    Teller teller(goal);
    teller.turn_to(" on " + follower.place().name);
    const TroubleNotes notes(follower, teller);
    WEAVE_TRY(const wire::Submit order, order_of(task, wish));
    WEAVE_TRY(const wire::Accepted accepted, wire::answer_of<wire::Accepted>(follower.ask(order, wire::answer_patience)));
    if (!accepted.job) return bad_input("the server gives the job no number", follower.place().name);
    const std::uint64_t job = *accepted.job;
    wire::JobWatch watch(follower, job, {[&](const wire::JobState& state) { teller(state); }, interrupted});
    const Result<wire::JobEnded> ended = watch.to_its_end();
    teller.end();
    if (!ended) return watch.is_lost() ? ended.error() : kept(ended.error(), job, wish);
    if (!wire::has_yarns(*ended)) {
        settle(outcome, follower, job);
        return wire::reason_of(*ended).in(wish.file);
    }
    if (Status files = keep_files(follower, *ended, task, wish); !files) return kept(std::move(files).error(), job, wish);
    const Json report = report_of(*ended, task);
    Json answer = report;
    answer["file"] = wish.out;
    answer["job"] = job;
    answer["server"] = follower.place().name;
    Status evidence;
    if (!wish.evidence.empty()) evidence = wire::check_signed(follower, *ended);
    if (!evidence) answer["error"] = error_json(evidence.error());
    WEAVE_CHECK_OK(tell_ending(outcome, report, std::move(answer), {design, task.flips, wish.save_design}));
    settle(outcome, follower, job);
    return evidence;
}

}  // namespace weave::program
