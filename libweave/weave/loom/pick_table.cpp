#include <weave/loom/pick_table.hpp>

#include <string_view>

namespace weave {

namespace {

/// A field of a CSV line (RFC 4180). What a spreadsheet would take for a formula gets an apostrophe in front,
/// which marks it as text: a foreign design's yarn names must not run in the mill's office.
std::string field(std::string text) {
    if (!text.empty() && std::string_view("=+-@\t\r").find(text[0]) != std::string_view::npos)
        text.insert(0, "'");
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"') quoted += '"';
        quoted += c;
    }
    return quoted + '"';
}

/// What the feeders of a pick have to say, joined by " + ".
template <class Say>
std::string of_feeders(const Pick& pick, Say say) {
    std::string text;
    for (const std::uint32_t feeder : pick.feeders) text += (text.empty() ? "" : " + ") + say(feeder);
    return text;
}

const YarnType& yarn_of_feeder(const Design& design, std::uint32_t feeder) {
    return design.weft.yarns.at(design.weft.feeders.at(feeder).yarn);
}

}  // namespace

std::string pick_table_csv(const Design& design, const std::vector<Pick>& picks,
                           const FeederMap* loom_feeders) {
    std::string csv = "pick,row,feeder,feeder name,direction,take-up,yarn,colour";
    csv += loom_feeders == nullptr ? "\r\n" : ",loom feeder\r\n";
    for (std::size_t k = 0; k < picks.size(); ++k) {
        const Pick& pick = picks[k];
        const bool no_weft = pick.feeders.empty();
        csv += std::to_string(k + 1) + ',' + std::to_string(pick.row + 1) + ',';
        csv += of_feeders(pick, [](std::uint32_t f) { return std::to_string(f + 1); }) + ',';
        csv += field(of_feeders(pick, [&](std::uint32_t f) { return design.weft.feeders.at(f).name; })) + ',';
        csv += no_weft                                      ? ","
               : pick.direction == Direction::left_to_right ? "left to right,"
                                                            : "right to left,";
        csv += pick.take_up ? "yes," : "no,";
        csv += field(of_feeders(pick, [&](std::uint32_t f) { return yarn_of_feeder(design, f).name; })) + ',';
        csv += of_feeders(pick, [&](std::uint32_t f) { return to_text(yarn_of_feeder(design, f).colour); });
        if (loom_feeders != nullptr)
            csv += ',' +
                   of_feeders(pick, [&](std::uint32_t f) { return std::to_string(loom_feeders->at(f) + 1); });
        csv += "\r\n";
    }
    return csv;
}

}  // namespace weave
