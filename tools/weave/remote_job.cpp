#include "remote_job.hpp"

#include "simulate_ending.hpp"

#include <weave/core/sha256.hpp>
#include <weave/core/text.hpp>
#include <weave/sim/yarns_file.hpp>

#include <algorithm>
#include <utility>

namespace weave::program {

namespace {

constexpr std::uint64_t most_yarns_bytes = std::uint64_t{8} << 30;

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

void settle(CommandOutcome& outcome, wire::Follower& follower, std::uint64_t job) {
    const Status settled = follower.acknowledge_job(job, wire::answer_patience);
    if (!settled) outcome.note(settled.error().text() + "; " + wire::name_of(job) + " is still kept there");
    follower.close();
}

Result<RemoteYarns> fetch_yarns(wire::Follower& follower, const wire::JobEnded& ended) {
    const std::string where = follower.place().name + ": " + wire::name_of(ended.job);
    if (!is_report(ended.report)) return bad_input("its report is not one that this program knows", where);
    WEAVE_TRY(std::string bytes, follower.download(wire::job_yarns(ended.job), most_yarns_bytes));
    if (sha256_hex(bytes) != ended.report.at("yarns_sha256")) return bad_input("its yarns are not those that its report tells of (SHA-256)", where);
    auto yarns = read_yarns(bytes);
    if (!yarns) return std::move(yarns).error().in(where);
    return RemoteYarns{std::move(bytes), std::move(*yarns)};
}

}  // namespace weave::program
