#pragma once

#include <weave/design/outline.hpp>
#include <weave/sim/yarns.hpp>

#include <QObject>

#include <memory>
#include <optional>
#include <studio/document/document.hpp>
#include <studio/panels/simulation_panel.hpp>
#include <studio/viewport/viewer_panel.hpp>

namespace weave::studio {

/// Gives the simulation the design and the viewer its yarns: as they move, and as they lie once they rest.
class SimulationDesk : public QObject {
    Q_OBJECT
  public:
    SimulationDesk(SimulationPanel& panel, ViewerPanel& viewer, QObject* parent);

    void show_document(Document* document);
    /// Flips a crossing of the cloth in the yarns that are shown; the design follows once that is done. False where nothing is simulated
    /// that shows this cloth, so that the flip is the design's alone.
    bool flip(const CardPlace& place);
    /// The latest yarns at rest or paused; null where there are none of the design as it stands.
    [[nodiscard]] std::shared_ptr<const Yarns> yarns() const { return m_panel.is_out_of_date() ? nullptr : m_yarns; }

  Q_SIGNALS:
    void failed(const QString& reason);
    void told(const QString& words);
    void place_wanted(const weave::CardPlace& place);
    /// The cloth was relaxed at another size than it has now, so that its plan is shown again, and the relaxed yarns are gone.
    void outgrown(const QString& words);
    /// Cloth came to rest, or was paused.
    void relaxed();

  private:
    void note_cloth();
    void follow_size();
    void forget_yarns();
    void take_layout(const std::shared_ptr<const YarnLayout>& layout);
    void take_frame(const std::shared_ptr<const Frame>& frame);
    void take_yarns(const std::shared_ptr<const Yarns>& yarns);
    void take_flip(const Flip& flip, bool done, const QString& reason);

    SimulationPanel& m_panel;
    ViewerPanel& m_viewer;
    Document* m_document = nullptr;
    std::shared_ptr<const YarnLayout> m_layout;
    std::uint64_t m_shown_layout = 0;  ///< that the viewer's yarns are of; 0: none
    std::shared_ptr<const Yarns> m_yarns;
    std::optional<BlockGrid> m_relaxed_cloth;  ///< that the run, if any, is of; none: the one that is being made
};

}  // namespace weave::studio
