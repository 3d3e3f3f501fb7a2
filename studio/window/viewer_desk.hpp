#pragma once

#include <weave/curve/cloth_curves.hpp>
#include <weave/sim/yarns.hpp>

#include <QObject>

#include <cstdint>
#include <memory>
#include <optional>
#include <studio/document/document.hpp>
#include <studio/viewport/viewport.hpp>

namespace weave::studio {

/// Brings the block that is shown into the 3D viewer, as it is planned or as it relaxed, and what is clicked there to the document.
class ViewerDesk : public QObject {
    Q_OBJECT
  public:
    /// Of a larger block only so many rows and columns are shown, round the place where the person is: more would not follow an edit
    /// within a blink.
    static constexpr std::size_t most_rows = 24, most_columns = 24;

    ViewerDesk(Viewport& viewport, QObject* parent);

    void show_document(Document* document);
    /// Relaxed yarns of the design's cloth, or of a part of it; null: there are none (any more).
    void show_relaxed(std::shared_ptr<const Yarns> yarns);
    /// Whether relaxed yarns are wanted where there are some; else the plan is shown.
    void prefer_relaxed(bool relaxed);
    [[nodiscard]] bool shows_relaxed() const { return m_prefers_relaxed && m_relaxed; }
    void set_colour(ColourBy colour);

  Q_SIGNALS:
    void told(const QString& words);
    /// A face of the block was clicked: what is to be attached there?
    void attach_wanted(weave::Face face);
    /// Two yarns were clicked that cross: they may be to change sides.
    void flip_wanted(const weave::CardPlace& place);

  private:
    void plan();
    void show_planned(std::shared_ptr<TubeModel> model, const QString& caption);
    void show_model();
    [[nodiscard]] std::optional<Region> region_to_show(const Block& block) const;

    Viewport& m_viewport;
    Document* m_document = nullptr;
    std::shared_ptr<TubeModel> m_planned, m_relaxed;
    QString m_caption;
    std::optional<Region> m_region;  ///< that is planned
    ColourBy m_colour = ColourBy::yarn;
    bool m_prefers_relaxed = true, m_is_planning = false, m_plan_again = false;
    std::string m_shown_block;
    std::uint64_t m_wanted = 0;
};

}  // namespace weave::studio
