#include <weave/curve/weft_parts.hpp>

#include <algorithm>

namespace weave {

namespace {

/// `times` copies of a card one after the other.
CardImage repeated(const CardImage& card, std::size_t times) {
    CardImage all(card.picks() * times, card.ends());
    for (std::size_t pick = 0; pick < all.picks(); ++pick) {
        const auto from = card.row(pick % card.picks());
        std::copy(from.begin(), from.end(), all.row(pick).begin());
    }
    return all;
}

std::size_t index(Side side) {
    return static_cast<std::size_t>(side);
}

class Wrapping {
  public:
    Wrapping(const Block& block, const std::vector<Pick>& picks, bool repeats)
        : m_block(block), m_parts(straight_parts(block, picks)) {
        const std::size_t times = repeats ? 3 : 1, own = repeats ? 1 : 0;
        std::vector<Pick> all;
        for (std::size_t k = 0; k < times; ++k) all.insert(all.end(), picks.begin(), picks.end());
        const WeftWay way = weft_way(repeated(block.card_image(), times), all);
        std::vector<Turn> turns;
        for (const Turn& turn : way.turns) {
            if (turn.from_pick / picks.size() == own) turns.push_back(turn);
        }
        for (const Turn& turn : turns) {
            const bool closes = turn.to_pick >= (own + 1) * picks.size();
            if (!closes || is_ring(turn.feeder, turns)) add(turn, own * picks.size(), picks.size());
        }
        pull_in();
    }

    WeftParts parts() && { return std::move(m_parts); }

  private:
    /// Whether a feeder's yarn turns after each of its picks. One that is open anywhere is cut between the
    /// repeats as well, so that all of it lies in the one.
    bool is_ring(std::uint32_t feeder, const std::vector<Turn>& turns) const {
        const auto is_its = [&](const auto& one) { return one.feeder == feeder; };
        return std::count_if(turns.begin(), turns.end(), is_its) ==
               std::count_if(m_parts.parts.begin(), m_parts.parts.end(), is_its);
    }

    /// Pick numbers of a turn less `before`.
    void add(Turn turn, std::size_t before, std::size_t picks) {
        turn.from_pick -= before;
        turn.to_pick -= before;
        if (turn.caught_by == CaughtBy::pick) turn.pick -= std::min(before, turn.pick);
        WeftBend bend{turn, part_of(turn.from_pick, turn.feeder), part_of(turn.to_pick % picks, turn.feeder),
                      turn.to_pick >= picks, 0};
        for (const std::size_t part : {bend.from, bend.to}) {
            m_parts.parts[part].turn[index(turn.side)] = m_parts.bends.size();
        }
        m_parts.bends.push_back(bend);
    }

    std::size_t part_of(std::size_t pick, std::uint32_t feeder) const {
        const auto at = std::lower_bound(
            m_parts.parts.begin(), m_parts.parts.end(), std::pair(pick, feeder),
            [](const WeftPart& part, const auto& key) { return std::pair(part.pick, part.feeder) < key; });
        return static_cast<std::size_t>(at - m_parts.parts.begin());
    }

    /// Ends every part at its turns, and every turn at the edge where one of its picks is crossed.
    void pull_in() {
        std::vector<bool> crossed;
        for (WeftPart& part : m_parts.parts) crossed.push_back(!pull_in(part));
        for (WeftBend& bend : m_parts.bends) {
            const bool left = bend.turn.side == Side::left;
            const bool at_edge = crossed[bend.from] || crossed[bend.to];
            bend.column = at_edge ? (left ? 0 : m_block.columns() - 1) : m_block.column_of_end(bend.turn.end);
            for (const std::size_t number : {bend.from, bend.to}) {
                WeftPart& part = m_parts.parts[number];
                (left ? part.first_column : part.last_column) = bend.column;
            }
        }
    }

    /// Whether something of the part stays in the cloth.
    bool pull_in(WeftPart& part) const {
        std::size_t first = 0, last = m_block.ends() - 1;
        for (const Side side : {Side::left, Side::right}) {
            if (part.turn[index(side)] == WeftPart::none) continue;
            const Turn& turn = m_parts.bends[part.turn[index(side)]].turn;
            if (turn.caught_by == CaughtBy::none) return false;
            (side == Side::left ? first : last) = turn.end;
        }
        if (first > last) return false;
        part.first_end = first;
        part.last_end = last;
        return true;
    }

    const Block& m_block;
    WeftParts m_parts;
};

}  // namespace

WeftParts straight_parts(const Block& block, const std::vector<Pick>& picks) {
    WeftParts all;
    for (std::size_t pick = 0; pick < picks.size(); ++pick) {
        std::vector<std::uint32_t> feeders = picks[pick].feeders;
        std::sort(feeders.begin(), feeders.end());
        const auto half = (static_cast<double>(feeders.size()) - 1) / 2;
        for (std::size_t k = 0; k < feeders.size(); ++k) {
            WeftPart part;
            part.feeder = feeders[k];
            part.pick = pick;
            part.row = picks[pick].row;
            part.last_end = block.ends() - 1;
            part.last_column = block.columns() - 1;
            part.is_leftwards = picks[pick].direction == Direction::right_to_left;
            part.offset = (static_cast<double>(k) - half) / 2;
            all.parts.push_back(part);
        }
    }
    return all;
}

WeftParts wrapped_parts(const Block& block, const std::vector<Pick>& picks, bool repeats) {
    return Wrapping(block, picks, repeats).parts();
}

WeftParts cut(const WeftParts& whole, const Region& region) {
    WeftParts part_of_it;
    std::vector<std::size_t> number(whole.parts.size(), WeftPart::none);
    for (std::size_t k = 0; k < whole.parts.size(); ++k) {
        WeftPart part = whole.parts[k];
        part.first_column = std::max(part.first_column, region.first_column);
        part.last_column = std::min(part.last_column, region.last_column);
        if (part.row < region.first_row || part.row > region.last_row || part.first_column > part.last_column)
            continue;
        part.turn = {WeftPart::none, WeftPart::none};
        number[k] = part_of_it.parts.size();
        part_of_it.parts.push_back(part);
    }
    for (WeftBend bend : whole.bends) {
        bend.from = number[bend.from];
        bend.to = number[bend.to];
        const bool inside = bend.column >= region.first_column && bend.column <= region.last_column;
        if (bend.from == WeftPart::none || bend.to == WeftPart::none || !inside || bend.closes) continue;
        for (const std::size_t part : {bend.from, bend.to}) {
            part_of_it.parts[part].turn[index(bend.turn.side)] = part_of_it.bends.size();
        }
        part_of_it.bends.push_back(bend);
    }
    return part_of_it;
}

}  // namespace weave
