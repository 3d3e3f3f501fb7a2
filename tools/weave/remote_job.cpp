#include "remote_job.hpp"

#include "simulate_ending.hpp"

#include <weave/core/sha256.hpp>
#include <weave/core/text.hpp>
#include <weave/keys/hash.hpp>
#include <weave/sim/yarns_file.hpp>
#include <weave/wire/evidence.hpp>

#include <algorithm>
#include <utility>

namespace weave::program {

namespace {

constexpr std::uint64_t most_yarns_bytes = std::uint64_t{8} << 30;
constexpr std::uint64_t most_evidence_bytes = std::uint64_t{64} << 20;

/// Whether all texts can be shown to a person as they stand.
bool is_plain(const Json& value) {
    const auto shows = [](const std::string& text) { return on_one_line(text) == text; };
    if (value.is_string()) return shows(value.get_ref<const std::string&>());
    if (value.is_object())
        return std::ranges::all_of(value.items(), [&](const auto& item) { return shows(item.key()) && is_plain(item.value()); });
    return !value.is_array() || std::ranges::all_of(value, is_plain);
}

/// Whether a report has what every report of `weave simulate` has.
bool is_report(const Json& report) {
    try {
        if (report.contains("flips") && !report.at("flips").is_array()) return false;
        return is_plain(report) && !ending_in_words(report).empty() && (is_good(report) || !report.empty()) &&
               report.at("yarns_sha256").is_string() && report.at("ending").is_string();
    } catch (const Json::exception&) {
        return false;
    }
}

}  // namespace

Result<wire::Follower> connected(const wire::ServerPlace& place) {
    return wire::Follower::connect(place, "weave " WEAVE_VERSION, server_patience);
}

Result<wire::JobList> jobs_of(wire::Follower& follower) {
    return wire::answer_of<wire::JobList>(follower.ask(wire::ListJobs{wire::new_request_id()}, answer_patience));
}

Status check_signs(wire::Follower& follower) {
    WEAVE_TRY(const wire::JobList jobs, jobs_of(follower));
    if (jobs.signs) return {};
    return Error{ErrorCode::refused, "the server has no key to sign evidence with (--evidence)", follower.place().name};
}

void settle(CommandOutcome& outcome, wire::Follower& follower, std::uint64_t job) {
    const Status settled = follower.acknowledge_job(job, answer_patience);
    if (!settled) outcome.note(settled.error().text() + "; " + name_of(job) + " is still kept there");
    follower.close();
}

std::string name_of(std::uint64_t job) {
    return "job " + std::to_string(job);
}

bool has_yarns(const wire::JobEnded& ended) {
    return ended.phase != wire::JobPhase::failed && !ended.report.empty();
}

Error reason_of(const wire::JobEnded& ended) {
    if (ended.error) return *ended.error;
    if (ended.phase == wire::JobPhase::cancelled) return invalid("was cancelled before it began: there are no yarns", name_of(ended.job));
    return system_fault("ended without yarns and without a reason", name_of(ended.job));
}

Result<RemoteYarns> fetch_yarns(wire::Follower& follower, const wire::JobEnded& ended) {
    const std::string where = follower.place().name + ": " + name_of(ended.job);
    if (!is_report(ended.report)) return bad_input("its report is not one that this program knows", where);
    WEAVE_TRY(std::string bytes, follower.download(wire::job_yarns(ended.job), most_yarns_bytes));
    if (sha256_hex(bytes) != ended.report.at("yarns_sha256")) return bad_input("its yarns are not those that its report tells of (SHA-256)", where);
    auto yarns = read_yarns(bytes);
    if (!yarns) return std::move(yarns).error().in(where);
    return RemoteYarns{std::move(bytes), std::move(*yarns)};
}

Status check_signed(const wire::Follower& follower, const wire::JobEnded& ended) {
    if (ended.evidence) return {};
    const bool is_done = ended.phase == wire::JobPhase::done;
    return Error{ErrorCode::refused, is_done ? "the server had no key to sign evidence with" : "only of a job that is done there is evidence",
                 follower.place().name + ": " + name_of(ended.job)};
}

Result<std::string> fetch_evidence(wire::Follower& follower, const wire::JobEnded& ended) {
    const std::string where = follower.place().name + ": " + name_of(ended.job);
    WEAVE_CHECK_OK(check_signed(follower, ended));
    WEAVE_TRY(std::string bytes, follower.download(wire::job_evidence(ended.job), most_evidence_bytes));
    if (canonical_json(*ended.evidence) != bytes) return bad_input("its evidence is another than was told", where);
    auto evidence = wire::read_evidence(bytes);
    if (!evidence) return std::move(evidence).error().in(where);
    WEAVE_TRY(const wire::SimulationStatement statement, wire::read_simulation(evidence->statement));
    if (hash_hex(statement.result_sha256) != ended.report.at("yarns_sha256")) return bad_input("its evidence is of other yarns", where);
    return bytes;
}

}  // namespace weave::program
