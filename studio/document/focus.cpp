#include <studio/document/focus.hpp>

namespace weave::studio {

void Focus::show_block(const std::string& block) {
    if (block == m_block) return;
    m_block = block;
    m_place.reset();
    Q_EMIT block_changed();
}

void Focus::go_to(const CardPlace& place) {
    m_place = place;
    Q_EMIT place_changed();
}

}  // namespace weave::studio
