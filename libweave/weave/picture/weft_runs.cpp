#include <weave/picture/weft_runs.hpp>

#include <algorithm>

namespace weave {

WeftRuns::WeftRuns(const Subject& subject, const YarnColours& colours)
    : m_block(subject.block), m_wraparound(subject.design.scene.weft_mode == WeftMode::wraparound) {
    const std::size_t last = m_block.columns() - 1;
    m_runs.resize(m_block.picks());
    for (std::size_t pick = 0; pick < m_runs.size(); ++pick) {
        const bool leftwards = colours.picks()[pick].direction == Direction::right_to_left;
        m_runs[pick] = {colours.has_weft(pick), 0, last, leftwards};
    }
    if (!m_wraparound) return;
    m_way = weft_way(m_block.card_image(), colours.picks());
    std::vector<bool> met(m_runs.size());
    for (const PickSpan& span : m_way.spans) {
        if (span.pick >= m_runs.size()) continue;
        Run& run = m_runs[span.pick];
        const std::size_t first =
            span.crossed ? 0 : m_block.column_of_end(std::min(span.first, m_block.ends() - 1));
        const std::size_t end =
            span.crossed ? last : m_block.column_of_end(std::min(span.last, m_block.ends() - 1));
        run.first =
            met[span.pick] ? std::min(run.first, first) : first;  // two feeders in one pick: both together
        run.last = met[span.pick] ? std::max(run.last, end) : end;
        met[span.pick] = true;
    }
}

std::size_t WeftRuns::column_of(const Turn& turn) const {
    if (turn.caught_by == CaughtBy::none) return turn.side == Side::left ? 0 : m_block.columns() - 1;
    return m_block.column_of_end(turn.end);
}

}  // namespace weave
