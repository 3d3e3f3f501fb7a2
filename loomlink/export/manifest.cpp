#include <loomlink/export/manifest.hpp>

#include <weave/core/sha256.hpp>

#include <algorithm>

namespace weave::loomlink {

namespace {

const char* name_of(HookRule rule) {
    switch (rule) {
        case HookRule::straight:
            return "straight";
        case HookRule::point:
            return "point";
        case HookRule::repeats:
            return "repeats";
        case HookRule::list:
            return "list";
    }
    return "";
}

const char* name_of(FeederEncoding encoding) {
    switch (encoding) {
        case FeederEncoding::none:
            return "none";
        case FeederEncoding::one_hot:
            return "one-hot";
        case FeederEncoding::binary:
            return "binary";
        case FeederEncoding::hooks:
            return "hooks";
        case FeederEncoding::binary_hooks:
            return "binary-hooks";
    }
    return "";
}

/// The hooks of one use, as ranges.
Json ranges_of(const std::vector<HookUse>& uses, HookUse wanted) {
    Json ranges = Json::array();
    for (std::size_t hook = 0; hook < uses.size(); ++hook) {
        if (uses[hook] != wanted) continue;
        if (!ranges.empty() && ranges.back()[1].get<std::size_t>() + 1 == hook)
            ranges.back()[1] = hook;
        else
            ranges.push_back(Json::array({hook, hook}));
    }
    return ranges;
}

}  // namespace

Json file_entry(const PackageFile& file) {
    return {{"path", file.path},     {"size", file.bytes.size()}, {"sha256", sha256_hex(file.bytes)},
            {"format", file.format}, {"certified", false},        {"label", layout_label},
            {"read_back", "equal"}};
}

Json controller_reading(const HookPlan& plan, const LoomProfile& profile, std::size_t ends) {
    const std::size_t last = plan.lifts.picks() - 1;
    return {
        {"lifted_hook_bit", profile.lifted_is_one ? 1 : 0},
        {"down_hook_bit", profile.lifted_is_one ? 0 : 1},
        {"cast_out_hook_bit", profile.lifted_is_one ? 0 : 1},
        {"selected_function_bit", 1},
        {"function_bytes", profile.function_bytes},
        {"bit_order", profile.least_bit_first ? "least significant bit first" : "most significant bit first"},
        {"record_order", profile.pick_1_at_bottom ? "as woven" : "last woven first"},
        {"lead_in_picks", plan.lead_in},
        {"pick_1_record", profile.pick_1_at_bottom ? plan.lead_in : last - plan.lead_in},
        {"end_1_hooks", hooks_of_end(profile, 0, ends)},
        {"areas_on_bytes", profile.areas_on_bytes},
        {"hook_places",
         profile.hook_permutation.empty() ? Json("as counted") : Json(profile.hook_permutation)},
        {"seen_from", "face"}};
}

Json hooks_entry(const HookPlan& plan, const LoomProfile& profile, std::size_t ends) {
    Json areas = Json::array();
    for (const HookArea& area : profile.areas) areas.push_back({{"name", area.name}, {"hooks", area.hooks}});
    Json tied = Json::array();
    if (profile.hook_rule == HookRule::list) {
        tied = Json(std::vector<std::size_t>(
            profile.hook_of_end.begin(), profile.hook_of_end.begin() + static_cast<std::ptrdiff_t>(ends)));
    }
    return {{"count", profile.total_hooks},
            {"counted_from", 0},
            {"areas", std::move(areas)},
            {"rule", name_of(profile.hook_rule)},
            {"end_1_at_first_body_hook", profile.end_1_at_left},
            {"hook_of_end", std::move(tied)},
            {"body", ranges_of(plan.uses, HookUse::body)},
            {"selvedge", ranges_of(plan.uses, HookUse::selvedge)},
            {"constant_on", ranges_of(plan.uses, HookUse::constant_on)},
            {"feeders", ranges_of(plan.uses, HookUse::feeder)},
            {"regulator", ranges_of(plan.uses, HookUse::regulator)},
            {"cast_out", ranges_of(plan.uses, HookUse::cast_out)}};
}

Json feeders_entry(const Design& design, const LoomProfile& profile, const FeederMap& feeders) {
    Json map = Json::array();
    for (const auto& [feeder, on_loom] : feeders) {
        const Feeder& said = design.weft.feeders.at(feeder);
        map.push_back({{"design_feeder", feeder + 1},
                       {"name", said.name},
                       {"yarn", design.weft.yarns.at(said.yarn).name},
                       {"loom_feeder", on_loom + 1}});
    }
    return {{"counted_from", 1},
            {"on_loom", profile.feeders},
            {"encoding", name_of(profile.feeder_encoding)},
            {"places", profile.feeder_hooks},
            {"map", std::move(map)}};
}

Json take_up_entry(const std::vector<Pick>& picks, const LoomProfile& profile) {
    const auto still =
        std::count_if(picks.begin(), picks.end(), [](const Pick& pick) { return !pick.take_up; });
    const bool stops = !takes_picture(profile.output) && !profile.regulator_hooks.empty();
    return {
        {"picks_without", still}, {"in_file", stops}, {"told_by", stops ? "regulator hooks" : "pick table"}};
}

}  // namespace weave::loomlink
