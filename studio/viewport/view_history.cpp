#include <studio/viewport/view_history.hpp>

namespace weave::studio {

void ViewHistory::note(const Camera& camera) {
    if (m_at > 0 && m_views[m_at - 1] == camera) return;
    m_views.resize(m_at);
    m_views.push_back(camera);
    if (m_views.size() > most) m_views.erase(m_views.begin());
    m_at = m_views.size();
}

void ViewHistory::clear() {
    m_views.clear();
    m_at = 0;
}

}  // namespace weave::studio
