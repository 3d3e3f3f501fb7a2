#include <weave/loom/pick_table.hpp>

#include <string_view>

namespace weave {

namespace {

Direction opposite(Direction direction) {
    return direction == Direction::left_to_right ? Direction::right_to_left : Direction::left_to_right;
}

/// Where every feeder's next pick goes if each goes back and forth, the first time from the left.
class Shuttles {
  public:
    explicit Shuttles(std::size_t feeders) : m_next(feeders, Direction::left_to_right) {}

    /// The direction of a pick: its first feeder decides. All its feeders then stand on the side where it
    /// ended.
    Direction throw_pick(const FeederSet& feeders) {
        if (feeders.empty()) return Direction::left_to_right;
        const Direction direction = m_next.at(feeders.front());
        for (const std::uint32_t feeder : feeders) m_next.at(feeder) = opposite(direction);
        return direction;
    }

  private:
    std::vector<Direction> m_next;
};

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

std::vector<Pick> pick_table(const Design& design, const Block& block, std::size_t repeats) {
    const WeftPlan& plan = design.weft;
    Shuttles shuttles(plan.feeders.size());
    std::vector<Pick> picks;
    picks.reserve(repeats * block.picks());
    for (std::size_t n = 0; n < repeats * block.rows(); ++n) {
        const std::size_t row = n % block.rows();
        for (std::size_t k = block.first_pick(row); k < block.first_pick(row + 1); ++k) {
            Pick pick;
            if (!plan.feeder_order.empty()) pick.feeders = plan.feeder_order[k % plan.feeder_order.size()];
            pick.row = n;
            pick.direction = plan.directions.empty() ? shuttles.throw_pick(pick.feeders)
                                                     : plan.directions[k % plan.directions.size()];
            pick.take_up = plan.take_up.empty() ? k + 1 == block.first_pick(row + 1)
                                                : plan.take_up[k % plan.take_up.size()];
            picks.push_back(std::move(pick));
        }
    }
    return picks;
}

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

const YarnType& yarn_of_end(const Design& design, std::size_t end) {
    return design.warp.yarns.at(design.warp.order.at(end));
}

Colour colour_of_end(const Design& design, std::size_t end) {
    const std::uint32_t colour = design.warp.colour_order.at(end);
    return colour == 0 ? yarn_of_end(design, end).colour : design.warp.colours.at(colour - 1);
}

const YarnType* yarn_of_pick(const Design& design, const Pick& pick) {
    return pick.feeders.empty() ? nullptr : &yarn_of_feeder(design, pick.feeders.front());
}

}  // namespace weave
