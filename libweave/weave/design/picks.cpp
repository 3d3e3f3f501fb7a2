#include <weave/design/picks.hpp>

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

}  // namespace

std::vector<Pick> pick_table(const Design& design, const BlockGrid& cloth, std::size_t repeats) {
    const WeftPlan& plan = design.weft;
    Shuttles shuttles(plan.feeders.size());
    std::vector<Pick> picks;
    picks.reserve(repeats * cloth.picks());
    for (std::size_t n = 0; n < repeats * cloth.rows(); ++n) {
        const std::size_t row = n % cloth.rows();
        for (std::size_t k = cloth.first_pick(row); k < cloth.first_pick(row + 1); ++k) {
            Pick pick;
            if (!plan.feeder_order.empty()) pick.feeders = plan.feeder_order[k % plan.feeder_order.size()];
            pick.row = n;
            pick.direction = plan.directions.empty() ? shuttles.throw_pick(pick.feeders)
                                                     : plan.directions[k % plan.directions.size()];
            pick.take_up = plan.take_up.empty() ? k + 1 == cloth.first_pick(row + 1)
                                                : plan.take_up[k % plan.take_up.size()];
            picks.push_back(std::move(pick));
        }
    }
    return picks;
}

const YarnType& yarn_of_end(const Design& design, std::size_t end) {
    return design.warp.yarns.at(design.warp.order.at(end));
}

Colour colour_of_end(const Design& design, std::size_t end) {
    const std::uint32_t colour = design.warp.colour_order.at(end);
    return colour == 0 ? yarn_of_end(design, end).colour : design.warp.colours.at(colour - 1);
}

const YarnType* yarn_of_pick(const Design& design, const Pick& pick) {
    if (pick.feeders.empty()) return nullptr;
    return &design.weft.yarns.at(design.weft.feeders.at(pick.feeders.front()).yarn);
}

}  // namespace weave
