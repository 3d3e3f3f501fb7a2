#include <studio/window/viewer_desk.hpp>

#include <algorithm>
#include <studio/jobs/background.hpp>
#include <utility>

namespace weave::studio {

namespace {

/// How a design is looked at that nobody has looked at.
Json whole_and_free() {
    return {{"repeat", {1, 1}}, {"cut", {{"across", "none"}}}, {"locked", false}};
}

/// So many lines round one, within all that there are.
std::pair<std::size_t, std::size_t> lines_round(std::size_t line, std::size_t all, std::size_t most) {
    if (all <= most) return {0, all - 1};
    const std::size_t first = std::min(line < most / 2 ? 0 : line - most / 2, all - most);
    return {first, first + most - 1};
}

bool holds(const Region& region, std::size_t row, std::size_t column) {
    return row >= region.first_row && row <= region.last_row && column >= region.first_column && column <= region.last_column;
}

/// A block beside the cloth, or within it: its columns are as wide as the cloth's, however many ends these have, and its wefts do not
/// turn at edges that are the cloth's.
Design as_part_of(const Block& cloth, const Block& block, Design design) {
    const auto ends_a_column = [](const Block& of) { return static_cast<double>(of.ends()) / static_cast<double>(of.columns()); };
    design.warp.density_ends_per_cm *= ends_a_column(block) / ends_a_column(cloth);
    design.scene.weft_mode = WeftMode::periodic;
    return design;
}

Result<ClothCurves> planned_curves(const Design& design, const Block& block, const std::optional<Region>& region) {
    CurveOptions options;
    options.region = region;
    // Turns lie at the sides; a part without sides has none, and need not follow every shuttle through the whole cloth.
    if (region && region->first_column > 0 && region->last_column + 1 < block.columns()) options.weft_mode = WeftMode::periodic;
    return cloth_curves(design, block, options);
}

}  // namespace

ViewerDesk::ViewerDesk(ViewerPanel& panel, QObject* parent) : QObject(parent), m_panel(panel) {
    follow_clicks();
}

void ViewerDesk::follow_clicks() {
    Viewport* viewport = m_panel.viewport();
    // Relaxed is the cloth, whichever of its blocks is being edited.
    const auto show_what_is_clicked = [this] {
        if (m_panel.mode() == ViewerPanel::Mode::relaxed) m_document->focus().show_block(m_document->design().root);
    };
    connect(viewport, &Viewport::yarn_clicked, this, [this, show_what_is_clicked](System system, std::size_t number) {
        if (m_document == nullptr) return;
        show_what_is_clicked();
        CardPlace place = m_document->focus().place().value_or(CardPlace{});
        (system == System::weft ? place.pick : place.end) = number;
        m_document->focus().go_to(place);
    });
    connect(viewport, &Viewport::crossing_clicked, this, [this, show_what_is_clicked](std::size_t pick, std::size_t end) {
        if (m_document == nullptr) return;
        show_what_is_clicked();
        Q_EMIT flip_wanted({pick, end});
    });
    connect(viewport, &Viewport::face_clicked, this, &ViewerDesk::attach_wanted);
}

void ViewerDesk::show_document(Document* document) {
    if (m_document != nullptr) {
        m_document->disconnect(this);
        m_document->focus().disconnect(this);
        m_document->focus().disconnect(m_panel.viewport());
    }
    m_document = document;
    m_shown_block.clear();
    m_region.reset();
    m_wanted_view = {};
    static_cast<void>(m_panel.set_state(whole_and_free()));  // cut, repeats and lock were of the other design
    ++m_wanted;
    m_panel.viewport()->let_go();
    m_panel.viewport()->set_attach_mode(false);
    m_panel.set_caption(ViewerPanel::Mode::planned, {});
    m_panel.set_no_plan();
    if (document == nullptr) return;
    connect(document, &Document::shown_made, this, &ViewerDesk::plan);
    connect(&document->focus(), &Focus::block_changed, m_panel.viewport(), [viewport = m_panel.viewport()] {
        viewport->let_go();  // its yarns have other numbers
        viewport->set_attach_mode(false);  // which was asked for at the block before
    });
    connect(&document->focus(), &Focus::place_changed, this, [this] {
        const auto& place = m_document->focus().place();
        const BlockPtr& block = m_document->shown().block;
        if (!place || !block || place->pick >= block->picks() || place->end >= block->ends()) return;
        // While a plan is under way, it is of where the person was when it began.
        const bool is_in_sight = !m_is_planning && (!m_region || holds(*m_region, block->row_of_pick(place->pick), block->column_of_end(place->end)));
        if (!is_in_sight) plan();
    });
    plan();
}

void ViewerDesk::point_out(std::optional<std::size_t> pick, std::optional<std::size_t> end) {
    std::vector<YarnName> yarns;
    if (pick) yarns.push_back({System::weft, *pick});
    if (end) yarns.push_back({System::warp, *end});
    m_panel.viewport()->point_out(std::move(yarns));
}

std::optional<Region> ViewerDesk::region_to_show(const Block& block) const {
    if (block.rows() * block.columns() <= most_cells) return std::nullopt;
    const CardPlace place = m_document->focus().place().value_or(CardPlace{});
    const std::size_t row = block.row_of_pick(std::min(place.pick, block.picks() - 1)), column = block.column_of_end(std::min(place.end, block.ends() - 1));
    // Work within what is shown does not move it.
    const bool is_same = m_region && m_shown_block == m_document->shown_block() && m_region->last_row < block.rows() && m_region->last_column < block.columns();
    if (is_same && holds(*m_region, row, column)) return m_region;
    const auto [first_row, last_row] = lines_round(row, block.rows(), most_rows);
    const auto [first_column, last_column] = lines_round(column, block.columns(), most_columns);
    return Region{first_row, last_row, first_column, last_column};
}

/// One plan at a time: a newer wish waits for the one under way, so that a person who clicks fast sees the last state soon.
void ViewerDesk::plan() {
    if (m_document == nullptr) return;
    const BlockPtr block = m_document->shown().block;
    if (!block) {
        const auto& error = m_document->shown().error;
        return m_panel.set_no_plan(error ? QString::fromStdString(error->text()) : tr("The block is being made."));
    }
    if (m_is_planning) {
        m_plan_again = true;
        return;
    }
    m_is_planning = true;
    const std::optional<Region> region = region_to_show(*block);
    QString caption;
    if (region)
        caption = tr("Picks %1–%2, ends %3–%4 of a larger block")
                      .arg(block->first_pick(region->first_row) + 1)
                      .arg(block->first_pick(region->last_row + 1))
                      .arg(block->first_end(region->first_column) + 1)
                      .arg(block->first_end(region->last_column + 1));
    const std::uint64_t wanted = m_wanted;
    const BlockPtr& cloth = m_document->whole().block;
    const bool is_part = cloth && m_document->shown_block() != m_document->design().root;
    auto design = std::make_shared<const Design>(is_part ? as_part_of(*cloth, *block, m_document->design()) : m_document->design());
    in_background(
        this, [design, block, region] { return planned_curves(*design, *block, region); },
        [=, this](Result<ClothCurves> curves) {
            m_is_planning = false;
            if (wanted == m_wanted) {
                const bool has_moved = m_region != region;
                m_region = region;
                m_panel.set_caption(ViewerPanel::Mode::planned, caption);
                if (curves) show_planned(design, std::make_shared<const ClothCurves>(std::move(*curves)), has_moved);
                else m_panel.set_no_plan(QString::fromStdString(curves.error().text()));
            }
            if (std::exchange(m_plan_again, false)) plan();
        });
}

void ViewerDesk::show_planned(std::shared_ptr<const Design> design, std::shared_ptr<const ClothCurves> curves, bool has_moved) {
    // What is another block, another part of it, or has another size, is shown whole; an edit leaves the view where it is.
    const bool is_other = has_moved || m_shown_block != m_document->shown_block() || m_shown_size != curves->size_mm;
    m_shown_block = m_document->shown_block();
    m_shown_size = curves->size_mm;
    m_panel.set_planned(std::move(design), std::move(curves));
    if (!is_other || m_panel.mode() != ViewerPanel::Mode::planned) return;
    connect(&m_panel, &ViewerPanel::model_shown, this, &ViewerDesk::look_at_plan, Qt::SingleShotConnection);
}

void ViewerDesk::look_at_plan() {
    const Json view = std::exchange(m_wanted_view, {});
    if (!view.is_object() || !m_panel.set_state(view)) m_panel.viewport()->fit();
}

// ---- How it is looked at ----

Json ViewerDesk::view() const {
    if (m_document == nullptr || m_panel.viewport()->model() == nullptr) return Json::object();
    Json seen = m_panel.state();
    seen.erase("mode");  // relaxed yarns are not there when the design is opened again
    Json view{{"block", m_document->shown_block()}, {"seen", std::move(seen)}};
    if (const auto& place = m_document->focus().place()) view["place"] = {place->pick, place->end};
    return view;
}

void ViewerDesk::show_view(const Json& view) {
    const auto block = view.find("block"), place = view.find("place"), seen = view.find("seen");
    if (m_document == nullptr || block == view.end() || !block->is_string() || !m_document->design().blocks.contains(*block)) return;
    m_document->focus().show_block(*block);
    const auto counts = [](const Json& number) { return number.is_number_unsigned(); };
    if (place != view.end() && place->is_array() && place->size() == 2 && std::all_of(place->begin(), place->end(), counts))
        m_document->focus().go_to({(*place)[0], (*place)[1]});
    if (seen != view.end()) m_wanted_view = *seen;
}

}  // namespace weave::studio
