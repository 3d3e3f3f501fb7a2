#pragma once

#include <weave/curve/cloth_curves.hpp>

#include <QObject>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <studio/document/document.hpp>
#include <studio/viewport/viewer_panel.hpp>

namespace weave::studio {

/// Brings the block that is shown into the 3D viewer, as it is planned, and what is clicked there to the document; knows how it is
/// looked at.
class ViewerDesk : public QObject {
    Q_OBJECT
  public:
    /// A block of more stacks is shown in part, so many rows and columns round the place where the person is: more would not follow an
    /// edit within a blink.
    static constexpr std::size_t most_cells = 2500, most_rows = 24, most_columns = 24;

    ViewerDesk(ViewerPanel& panel, QObject* parent);

    void show_document(Document* document);
    /// How the document is looked at: the block, the place in it, and the 3D view; empty where nothing is seen yet.
    [[nodiscard]] Json view() const;
    /// Looks at the document as it was looked at when view() gave this; what does not fit it any more is left out.
    void show_view(const Json& view);
    /// A pick, an end, or both of the cloth stand out among its yarns, until the person lets go or looks at another block.
    void point_out(std::optional<std::size_t> pick, std::optional<std::size_t> end);

  Q_SIGNALS:
    /// A face of the block was clicked: what is to be attached there?
    void attach_wanted(weave::Face face);
    /// Two yarns were clicked that cross: they may be to change sides.
    void flip_wanted(const weave::CardPlace& place);

  private:
    void follow_clicks();
    void plan();
    void show_planned(std::shared_ptr<const Design> design, std::shared_ptr<const ClothCurves> curves, bool has_moved);
    void look_at_plan();
    [[nodiscard]] std::optional<Region> region_to_show(const Block& block) const;

    ViewerPanel& m_panel;
    Document* m_document = nullptr;
    std::optional<Region> m_region;  ///< that is planned
    bool m_is_planning = false, m_plan_again = false;
    std::string m_shown_block;
    std::array<double, 2> m_shown_size{};  ///< mm, of what is planned
    Json m_wanted_view;  ///< of the plan that is shown next; null: all of it
    std::uint64_t m_wanted = 0;
};

}  // namespace weave::studio
