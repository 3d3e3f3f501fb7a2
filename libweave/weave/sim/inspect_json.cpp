#include <weave/sim/inspect.hpp>
#include <weave/sim/report_words.hpp>

#include <cmath>

namespace weave {

namespace {

const char* name_of(System system) {
    return system == System::warp ? "end" : "pick";
}

Json yarn_json(const YarnNumber& yarn) {
    return {{"kind", name_of(yarn.system)}, {"number", yarn.number + 1}};
}

Json spread_json(const Spread& spread) {
    return {{"mean", spread.mean},
            {"least", spread.least},
            {"least_of", spread.least_of + 1},
            {"most", spread.most},
            {"most_of", spread.most_of + 1}};
}

Json spread_or_null(const std::optional<Spread>& spread) {
    return spread ? spread_json(*spread) : Json(nullptr);
}

Json numbers_json(const std::vector<std::size_t>& numbers) {
    Json list = Json::array();
    for (const std::size_t number : numbers) list.push_back(number + 1);
    return list;
}

template <class Item, class Write>
Json list_json(const std::vector<Item>& items, Write write) {
    Json list = Json::array();
    for (const Item& item : items) list.push_back(write(item));
    return list;
}

Json beam_json(const BeamTakeUp& beam) {
    Json json{{"beam", beam.beam + 1},
              {"ends", beam.ends},
              {"take_up", spread_json(beam.spread)},
              {"spread", beam.spread.most - beam.spread.least}};
    json["alike_ends_differ"] = beam.alike ? Json(*beam.alike) : Json(nullptr);
    if (beam.alike) json["alike_ends"] = {beam.alike_least_of + 1, beam.alike_most_of + 1};
    return json;
}

Json sheet_json(const std::vector<YarnNumber>& sheet) {
    std::vector<std::size_t> picks, ends;
    for (const YarnNumber& yarn : sheet) (yarn.system == System::warp ? ends : picks).push_back(yarn.number);
    return {{"picks", numbers_json(picks)}, {"ends", numbers_json(ends)}};
}

Json leaning_json(const LeaningLayer& layer) {
    return {{"kind", name_of(layer.system)},
            {"layer", layer.layer + 1},
            {"of", layer.of},
            {"mm", layer.mm},
            {"widths", layer.widths},
            {"same_way", layer.same_way},
            {"numbers", numbers_json(layer.numbers)}};
}

Json moved_json(const MovedYarn& moved) {
    Json json = yarn_json(moved.yarn);
    json["mm"] = moved.mm;
    json["widths"] = moved.widths;
    json["way_mm"] = {moved.way.x(), moved.way.y(), moved.way.z()};
    json["mean_mm"] = moved.mean_mm;
    json[moved.yarn.system == System::warp ? "at_pick" : "at_end"] = moved.crossed + 1;
    return json;
}

Json bunched_json(const BunchedPair& pair) {
    return {
        {"kind", name_of(pair.first.system)}, {"numbers", {pair.first.number + 1, pair.second.number + 1}},
        {"planned_mm", pair.planned_mm},      {"mm", pair.mm},
        {"touching", pair.touching},          {"next_repeat", pair.next_repeat}};
}

Json jammed_json(const JammedYarn& jammed) {
    Json json = yarn_json(jammed.yarn);
    json["places"] = jammed.places;
    json["of"] = jammed.of;
    json["between"] = {jammed.between[0] + 1, jammed.between[1] + 1};
    json["room"] = jammed.room;
    return json;
}

Json changed_json(const ChangedCrossing& changed) {
    return {{"pick", changed.pick + 1},
            {"end", changed.end + 1},
            {"card", changed.weft_over ? "weft over" : "warp over"},
            {"found", changed.found}};
}

Json stretch_json(const std::optional<NumberSpan>& stretch) {
    return stretch ? Json({(*stretch)[0] + 1, (*stretch)[1] + 1}) : Json(nullptr);
}

Json number_or_null(const std::optional<std::size_t>& number) {
    return number ? Json(*number) : Json(nullptr);
}

/// As `weave simulate` writes it today, also of files of earlier versions.
Json coverage_json(const Yarns& yarns, const InspectedPart& part) {
    Json coverage{{"rows", stretch_json(part.rows)},
                  {"columns", stretch_json(part.columns)},
                  {"repeats", sim::part_of(sim::part_of(yarns.report, "coverage"), "repeats")},
                  {"picks", stretch_json(part.picks)},
                  {"ends", stretch_json(part.ends)},
                  {"of",
                   {{"rows", part.cloth_rows},
                    {"columns", part.cloth_columns},
                    {"picks", number_or_null(part.cloth_picks)},
                    {"ends", number_or_null(part.cloth_ends)}}},
                  {"whole", part.is_whole}};
    return coverage;
}

Json measured_json(const Inspection& inspection) {
    return {{"picks", inspection.measured_picks},
            {"ends", inspection.measured_ends},
            {"left_out_rows", inspection.frozen_rims[0] ? disturbed_by_rim : 0},
            {"left_out_columns", inspection.frozen_rims[1] ? disturbed_by_rim : 0}};
}

/// What the report of the run says, or null.
Json reported(const Yarns& yarns, const char* name) {
    const auto found = yarns.report.find(name);
    return found == yarns.report.end() ? Json(nullptr) : *found;
}

}  // namespace

Json inspection_json(const Yarns& yarns, const Inspection& inspection) {
    Json json{
        {"title", yarns.title}, {"design_sha256", yarns.design_sha256}, {"scene_sha256", yarns.scene_sha256}};
    for (const char* name : {"fidelity", "converged", "residual", "max_overlap", "strain_deviation",
                             "friction", "starts", "symmetry", "goes_on"})
        json[name] = reported(yarns, name);
    json["smallest_curvature"] = sim::smallest_curvature(yarns.report);
    json["coverage"] = coverage_json(yarns, inspection.part);
    json["measured"] = measured_json(inspection);
    json["picks"] = inspection.picks;
    json["ends"] = inspection.ends;
    json["size_mm"] = {yarns.size_mm[0], yarns.size_mm[1]};
    json["thickness_mm"] = inspection.thickness_mm ? Json(*inspection.thickness_mm) : Json(nullptr);
    json["settled"] = inspection.settled;
    json["crimp"] = {{"warp", spread_or_null(inspection.warp_crimp)},
                     {"weft", spread_or_null(inspection.weft_crimp)}};
    json["take_up"] = list_json(inspection.take_up, [](const EndTakeUp& end) {
        return Json{{"end", end.end + 1}, {"beam", end.beam + 1}, {"take_up", end.take_up}};
    });
    json["beams"] = list_json(inspection.beams, beam_json);
    json["order_kept"] = inspection.changed.empty();
    json["changed_crossings"] = list_json(inspection.changed, changed_json);
    json["slid_crossings"] = list_json(inspection.slid, changed_json);
    json["sheets"] = list_json(inspection.sheets, sheet_json);
    json["leaning"] = list_json(inspection.leaning, leaning_json);
    json["bunched"] = list_json(inspection.bunched, bunched_json);
    json["moved"] = list_json(inspection.moved, moved_json);
    json["jammed"] = list_json(inspection.jammed, jammed_json);
    return json;
}

}  // namespace weave
