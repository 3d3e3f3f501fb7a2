#pragma once

#include <studio/viewport/camera.hpp>

#include <vector>

namespace weave::studio {

/// The views that somebody has had, to go back to. Moves of the view are no edits, so they are kept apart
/// from undo.
class ViewHistory {
  public:
    static constexpr std::size_t most = 100;

    /// Notes where a move ended; what had been gone back from is forgotten. Nothing is noted where nothing
    /// moved.
    void note(const Camera& camera);
    [[nodiscard]] bool can_go_back() const { return m_at > 1; }
    [[nodiscard]] bool can_go_on() const { return m_at < m_views.size(); }
    /// The view before or after the present one; there must be one.
    const Camera& back() { return m_views[--m_at - 1]; }
    const Camera& on() { return m_views[m_at++]; }
    void clear();

  private:
    std::vector<Camera> m_views;
    std::size_t m_at = 0;  ///< how many lead up to the present one, itself included
};

}  // namespace weave::studio
