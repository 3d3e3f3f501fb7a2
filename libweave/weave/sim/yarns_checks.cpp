#include <weave/sim/yarns_checks.hpp>

#include <weave/sim/plan.hpp>
#include <weave/sim/yarns_file.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace weave::yarns_detail {

namespace {

constexpr double largest_number = 1e300;

bool is_place(const Vec3& place) {
    return place.allFinite() && place.cwiseAbs().maxCoeff() <= farthest_place_mm;
}

/// No pick has more wefts: one of each of its feeders.
constexpr std::size_t most_wefts_of_pick = 2;

Status check_crossing(const Yarns& yarns, const Crossing& crossing) {
    const auto is_of = [&](std::size_t yarn, System system) {
        return yarn < yarns.yarns.size() && yarns.yarns[yarn].system == system;
    };
    const auto number = static_cast<std::size_t>(most_yarn_number);
    if (!is_of(crossing.weft, System::weft)) return bad_input("names a weft that is not there");
    if (!is_of(crossing.warp, System::warp)) return bad_input("names a warp that is not there");
    if (yarns.yarns[crossing.warp].number != crossing.end)
        return bad_input("names another end than that of its warp");
    if (yarns.yarns[crossing.weft].number > crossing.pick)
        return bad_input("names a pick before the first of its weft");
    if (crossing.weft_key >= most_file_points || crossing.warp_key >= most_file_points)
        return bad_input("has a key point beyond the limit");
    if (crossing.pick > number || crossing.end > number)
        return bad_input("has a pick or an end beyond the limit");
    return {};
}

bool is_amount(const Json& json) {
    return json.is_number() && json.get<double>() >= 0 && json.get<double>() <= largest_number;
}
bool is_count(const Json& json) {
    return json.is_number_unsigned() || (json.is_number_integer() && json.get<std::int64_t>() >= 0);
}
bool is_flag(const Json& json) {
    return json.is_boolean();
}
bool is_curvature(const Json& json) {
    return json == "positive" || json == "negative" || json == "unclear" || json == "not looked";
}
bool is_deviation(const Json& json) {
    const auto fits = [](const Json& share) { return share.is_null() || is_amount(share); };
    return json.is_object() && std::ranges::all_of(json, fits);
}

bool is_fidelity(const Json& json) {
    return json.is_string() && sim::parse_fidelity(json.get<std::string>());
}

/// A member of a report that people are told, and what it can be.
struct ReportMember {
    const char* name;
    bool (*fits)(const Json&);
    const char* wish;
};
constexpr const char* wish_amount = "must be a number from 0 on";
constexpr const char* wish_count = "must be a whole number from 0 on";
constexpr const char* wish_flag = "must be true or false";
constexpr ReportMember report_members[]{
    {"converged", is_flag, wish_flag},
    {"order_kept", is_flag, wish_flag},
    {"residual", is_amount, wish_amount},
    {"goal", is_amount, wish_amount},
    {"max_overlap", is_amount, wish_amount},
    {"seconds", is_amount, wish_amount},
    {"points", is_count, wish_count},
    {"contacts", is_count, wish_count},
    {"iterations", is_count, wish_count},
    {"lost_crossings", is_count, wish_count},
    {"slid_crossings", is_count, wish_count},
    {"goes_on", is_fidelity, "must be \"draft\", \"standard\" or \"reference\""},
    {"smallest_curvature", is_curvature, "must be \"positive\", \"negative\", \"unclear\" or \"not looked\""},
    {"strain_deviation", is_deviation, "must be an object of numbers from 0 on"},
};

}  // namespace

std::string yarn_place(std::size_t yarn) {
    return "yarns[" + std::to_string(yarn) + "]";
}

bool is_number(double value) {
    return std::abs(value) <= largest_number;
}

Status check_hash(const std::string& hash, const char* name) {
    const auto is_digit = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
    if (hash.empty() || (hash.size() == 64 && std::ranges::all_of(hash, is_digit))) return {};
    return bad_input("must be 64 digits 0-9 and a-f, or empty", name);
}

Status check_sizes(const SimulatedYarn& yarn) {
    const std::size_t points = yarn.spline.control.size();
    if (points < (yarn.spline.is_periodic ? 1U : 2U) || points > most_file_points)
        return bad_input("a yarn needs control points: two, or one if it is periodic", "points");
    if (yarn.planned.size() != points)
        return bad_input("must have a place for each control point", "planned");
    if (yarn.strain.size() != points) return bad_input("must have a number for each control point", "strain");
    if (yarn.contact_N.size() != points)
        return bad_input("must have a number for each control point", "contact_N");
    return {};
}

Status check_points(const SimulatedYarn& yarn) {
    for (std::size_t i = 0; i < yarn.spline.control.size(); ++i) {
        const std::string at = "[" + std::to_string(i) + "]";
        if (!is_place(yarn.spline.control[i]))
            return bad_input("is not a place within 1e9 mm", "control" + at);
        if (!is_place(yarn.planned[i])) return bad_input("is not a place within 1e9 mm", "planned" + at);
        if (!is_number(yarn.strain[i])) return bad_input("is not a finite number", "strain" + at);
        if (!is_number(yarn.contact_N[i])) return bad_input("is not a finite number", "contact_N" + at);
    }
    return {};
}

Status check_numbers(const Yarns& yarns) {
    std::map<std::pair<System, std::size_t>, std::size_t> seen;
    for (std::size_t y = 0; y < yarns.yarns.size(); ++y) {
        const SimulatedYarn& yarn = yarns.yarns[y];
        const bool warp = yarn.system == System::warp;
        if (++seen[{yarn.system, yarn.number}] <= (warp ? 1 : most_wefts_of_pick)) continue;
        const std::string number = std::to_string(yarn.number);
        return bad_input(warp ? "is warp " + number + " again: an end is one yarn"
                              : "is the third weft of number " + number + ": a pick has one or two feeders",
                         yarn_place(y) + ".number");
    }
    return {};
}

Status check_periods(const Yarns& yarns) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
        if (yarns.is_periodic[axis] && !(yarns.size_mm[axis] > 0))
            return bad_input("must be above 0 where the piece is periodic",
                             "size_mm[" + std::to_string(axis) + "]");
    }
    return {};
}

Status check_crossings(const Yarns& yarns) {
    for (std::size_t i = 0; i < yarns.crossings.size(); ++i) {
        if (auto status = check_crossing(yarns, yarns.crossings[i]); !status)
            return std::move(status).error().under("crossings[" + std::to_string(i) + "]");
    }
    return {};
}

Status check_report(const Json& report) {
    for (const ReportMember& member : report_members) {
        const auto found = report.find(member.name);
        if (found != report.end() && !member.fits(*found))
            return bad_input(member.wish, std::string("report.") + member.name);
    }
    return {};
}

}  // namespace weave::yarns_detail
