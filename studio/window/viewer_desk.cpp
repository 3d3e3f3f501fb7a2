#include <studio/window/viewer_desk.hpp>

#include <algorithm>
#include <studio/jobs/background.hpp>

namespace weave::studio {

namespace {

/// So many lines round one, within all that there are.
std::pair<std::size_t, std::size_t> lines_round(std::size_t line, std::size_t all, std::size_t most) {
    if (all <= most) return {0, all - 1};
    const std::size_t first = std::min(line < most / 2 ? 0 : line - most / 2, all - most);
    return {first, first + most - 1};
}

bool holds(const Region& region, std::size_t row, std::size_t column) {
    return row >= region.first_row && row <= region.last_row && column >= region.first_column && column <= region.last_column;
}

/// A model, or why there is none.
struct Planned {
    std::shared_ptr<TubeModel> model;
    QString trouble;
};

Planned planned_model(const Design& design, const Block& block, const std::optional<Region>& region, ColourBy colour) {
    CurveOptions options;
    options.region = region;
    // Turns lie at the sides; a part without sides has none, and need not follow every shuttle through the whole cloth.
    if (region && region->first_column > 0 && region->last_column + 1 < block.columns()) options.weft_mode = WeftMode::periodic;
    const auto curves = cloth_curves(design, block, options);
    if (!curves) return {nullptr, QString::fromStdString(curves.error().text())};
    auto model = TubeModel::planned(design, *curves, colour == ColourBy::system ? colour : ColourBy::yarn);
    if (!model) return {nullptr, QString::fromStdString(model.error().text())};
    return {std::make_shared<TubeModel>(std::move(*model)), {}};
}

}  // namespace

ViewerDesk::ViewerDesk(Viewport& viewport, QObject* parent) : QObject(parent), m_viewport(viewport) {
    connect(&viewport, &Viewport::yarn_clicked, this, [this](System system, std::size_t number) {
        if (m_document == nullptr) return;
        CardPlace place = m_document->focus().place().value_or(CardPlace{});
        (system == System::weft ? place.pick : place.end) = number;
        m_document->focus().go_to(place);
    });
    connect(&viewport, &Viewport::crossing_clicked, this, [this](std::size_t pick, std::size_t end) {
        if (m_document != nullptr) Q_EMIT flip_wanted({pick, end});
    });
    connect(&viewport, &Viewport::face_clicked, this, &ViewerDesk::attach_wanted);
}

void ViewerDesk::show_document(Document* document) {
    if (m_document != nullptr) {
        m_document->disconnect(this);
        m_document->focus().disconnect(this);
    }
    m_document = document;
    m_planned.reset();
    m_relaxed.reset();
    m_shown_block.clear();
    ++m_wanted;
    m_viewport.set_model(nullptr);
    if (document == nullptr) return;
    connect(document, &Document::shown_made, this, &ViewerDesk::plan);
    connect(&document->focus(), &Focus::place_changed, this, [this] {
        const auto& place = m_document->focus().place();
        const BlockPtr& block = m_document->shown().block;
        if (!place || !block || !m_region || place->pick >= block->picks() || place->end >= block->ends()) return;
        if (!holds(*m_region, block->row_of_pick(place->pick), block->column_of_end(place->end))) plan();
    });
    plan();
}

std::optional<Region> ViewerDesk::region_to_show(const Block& block) const {
    if (block.rows() <= most_rows && block.columns() <= most_columns) return std::nullopt;
    const CardPlace place = m_document->focus().place().value_or(CardPlace{});
    const auto [first_row, last_row] = lines_round(block.row_of_pick(std::min(place.pick, block.picks() - 1)), block.rows(), most_rows);
    const auto [first_column, last_column] = lines_round(block.column_of_end(std::min(place.end, block.ends() - 1)), block.columns(), most_columns);
    return Region{first_row, last_row, first_column, last_column};
}

/// One plan at a time: a newer wish waits for the one under way, so that a person who clicks fast sees the last state soon.
void ViewerDesk::plan() {
    if (m_document == nullptr) return;
    const BlockPtr block = m_document->shown().block;
    if (!block) {
        m_planned.reset();
        const auto& error = m_document->shown().error;
        m_viewport.set_empty_words(error ? QString::fromStdString(error->text()) : tr("The block is being made."));
        return show_model();
    }
    if (m_is_planning) {
        m_plan_again = true;
        return;
    }
    m_is_planning = true;
    const std::optional<Region> region = region_to_show(*block);
    QString caption;
    if (region)
        caption = tr("Picks %1–%2 and ends %3–%4 of a larger block: click on the card to go elsewhere")
                      .arg(block->first_pick(region->first_row) + 1)
                      .arg(block->first_pick(region->last_row + 1))
                      .arg(block->first_end(region->first_column) + 1)
                      .arg(block->first_end(region->last_column + 1));
    const std::uint64_t wanted = m_wanted;
    in_background(
        this, [design = m_document->design(), block, region, colour = m_colour] { return planned_model(design, *block, region, colour); },
        [this, wanted, region, caption](Planned planned) {
            m_is_planning = false;
            if (wanted == m_wanted) {
                m_region = region;
                if (!planned.model) m_viewport.set_empty_words(planned.trouble);
                show_planned(std::move(planned.model), caption);
            }
            if (std::exchange(m_plan_again, false)) plan();
        });
}

void ViewerDesk::show_planned(std::shared_ptr<TubeModel> model, const QString& caption) {
    m_planned = std::move(model);
    m_caption = caption;
    const bool is_other = m_shown_block != m_document->shown_block();
    m_shown_block = m_document->shown_block();
    show_model();
    if (is_other && !shows_relaxed()) m_viewport.fit();
}

void ViewerDesk::show_relaxed(std::shared_ptr<const Yarns> yarns) {
    m_relaxed.reset();
    if (yarns) {
        auto model = TubeModel::relaxed(std::move(yarns), m_colour);
        if (model) m_relaxed = std::make_shared<TubeModel>(std::move(*model));
        else Q_EMIT told(QString::fromStdString(model.error().text()));
    }
    show_model();
}

void ViewerDesk::prefer_relaxed(bool relaxed) {
    m_prefers_relaxed = relaxed;
    show_model();
}

void ViewerDesk::set_colour(ColourBy colour) {
    m_colour = colour;
    m_viewport.set_colour(colour);
}

void ViewerDesk::show_model() {
    m_viewport.set_model(shows_relaxed() ? m_relaxed : m_planned);
    m_viewport.set_caption(shows_relaxed() ? QString() : m_caption);
}

}  // namespace weave::studio
