#include <studio/editors/card_editor.hpp>

#include <weave/block/flip.hpp>
#include <weave/picture/layer_map.hpp>

#include <QAbstractItemView>
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QSignalBlocker>
#include <QSpinBox>
#include <QToolButton>
#include <QToolTip>

#include <algorithm>
#include <studio/editors/card_region.hpp>
#include <studio/editors/float_legend.hpp>
#include <studio/editors/plain_text.hpp>
#include <studio/jobs/background.hpp>

namespace weave::studio {

namespace {

/// What the modes' list holds as data: the mode, and the layer behind it.
int data_of(CardMode mode, std::size_t layer) {
    return static_cast<int>(mode) * 1000 + static_cast<int>(layer);
}

QSpinBox* times_box(const QString& tip, const QString& prefix) {
    auto* box = new QSpinBox;
    box->setRange(1, 20);
    box->setPrefix(prefix);
    box->setToolTip(tip);
    box->setAccessibleName(tip);
    return box;
}

}  // namespace

CardEditor::CardEditor(QWidget* parent) : QWidget(parent), m_canvas(new GridCanvas), m_region(new CardRegion(*m_canvas, this)), m_legend(new FloatLegend) {
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(2);
    for (auto make : {&CardEditor::make_view_row, &CardEditor::make_tool_row}) {
        auto* row = new QHBoxLayout;
        row->setContentsMargins(4, layout->count() == 0 ? 4 : 0, 4, 0);
        (this->*make)(*row);
        layout->addLayout(row);
    }
    layout->addWidget(m_canvas, 1);
    layout->addWidget(m_legend);
    m_legend->hide();
    m_canvas->setObjectName("card");
    m_canvas->setAccessibleName(tr("Card"));
    m_canvas->set_empty_text(tr("No card yet: start a design, or open one."));
    connect(m_canvas, &GridCanvas::stroked, this, &CardEditor::flip);
    connect(m_canvas, &GridCanvas::hovered, this, &CardEditor::tell_of);
    connect(m_canvas, &GridCanvas::menu_wanted, this, &CardEditor::offer);
    connect(m_region, &CardRegion::told, this, &CardEditor::told);
    connect(m_region, &CardRegion::refused, this, &CardEditor::explain);
    connect(m_canvas, &GridCanvas::chosen, this, [this](const GridCell& cell) {
        tell_of(cell);
        if (m_document != nullptr && m_block) m_document->focus().go_to(place_of(cell));
    });
    connect(m_canvas, &GridCanvas::too_far, this, [this](const GridCell& cell) {
        if (m_document == nullptr || !m_block) return;
        const CardPlace place = place_of(cell);
        m_document->focus().go_to(place);
        Q_EMIT told(tr("Pick %1, end %2: come nearer to flip (+, or the wheel)").arg(place.pick + 1).arg(place.end + 1));
    });
}

void CardEditor::make_view_row(QHBoxLayout& row) {
    m_modes = new QComboBox;
    m_modes->setObjectName("card-mode");
    m_modes->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    m_modes->setMinimumContentsLength(14);
    m_modes->view()->setMinimumWidth(fontMetrics().averageCharWidth() * 34);
    m_modes->setToolTip(tr("What is shown of the block"));
    m_modes->setAccessibleName(m_modes->toolTip());
    connect(m_modes, &QComboBox::currentIndexChanged, this, [this] {
        const int chosen = m_modes->currentData().toInt();
        show_mode(static_cast<CardMode>(chosen / 1000), static_cast<std::size_t>(chosen % 1000));
    });
    m_times_columns = times_box(tr("Repeats shown side by side, across the cloth"), "↔ ");
    m_times_rows = times_box(tr("Repeats shown above each other, along the cloth"), "↕ ");
    for (QSpinBox* box : {m_times_columns, m_times_rows}) connect(box, &QSpinBox::valueChanged, this, [this] { show_block(); });
    row.addWidget(m_modes, 1);
    auto* repeats = new QLabel(tr("Repeat"));
    repeats->setContentsMargins(6, 0, 0, 0);
    row.addWidget(repeats);
    row.addWidget(m_times_columns);
    row.addWidget(m_times_rows);
    list_modes();
}

void CardEditor::make_tool_row(QHBoxLayout& row) {
    const auto button = [&](const QString& tip) {
        auto* made = new QToolButton;
        made->setToolTip(tip);
        made->setAccessibleName(tip);
        made->setAutoRaise(true);
        row.addWidget(made);
        return made;
    };
    for (QAction* tool : m_region->tools()) button(tool->text())->setDefaultAction(tool);
    QToolButton* region = button(tr("What can be done with the chosen region"));
    region->setObjectName("region-menu");
    region->setText(tr("Region"));
    region->setPopupMode(QToolButton::InstantPopup);
    region->setMenu(new QMenu(region));
    m_region->fill_menu(*region->menu());
    row.addStretch();
    const auto view_button = [&](const QString& text, const QString& tip, void (GridCanvas::*what)()) {
        QToolButton* made = button(tip);
        made->setText(text);
        connect(made, &QToolButton::clicked, m_canvas, what);
    };
    view_button("−", tr("Smaller (−)"), &GridCanvas::zoom_out);
    view_button("+", tr("Larger (+)"), &GridCanvas::zoom_in);
    view_button(tr("Fit"), tr("Show all of it (F)"), &GridCanvas::fit);
}

void CardEditor::list_modes() {
    const QSignalBlocker quiet(m_modes);
    const int now = data_of(m_mode, m_layer);
    m_modes->clear();
    m_modes->addItem(tr("Card (black: end lifted)"), data_of(CardMode::card, 0));
    for (std::size_t layer = 0; layer < std::min<std::size_t>(m_layers, 16) && m_layers > 1; ++layer) {
        const QString where = layer == 0 ? tr(" (face)") : layer + 1 == m_layers ? tr(" (back)") : QString();
        m_modes->addItem(tr("Layer %1 of %2%3").arg(layer + 1).arg(m_layers).arg(where), data_of(CardMode::layer, layer));
    }
    m_modes->addItem(tr("Face, as it will look"), data_of(CardMode::face, 0));
    m_modes->addItem(tr("Back, seen through the cloth"), data_of(CardMode::back, 0));
    m_modes->addItem(tr("Floats on the face"), data_of(CardMode::face_floats, 0));
    m_modes->addItem(tr("Floats on the back"), data_of(CardMode::back_floats, 0));
    m_modes->setCurrentIndex(std::max(0, m_modes->findData(now)));
    const int chosen = m_modes->currentData().toInt();
    m_mode = static_cast<CardMode>(chosen / 1000);
    m_layer = static_cast<std::size_t>(chosen % 1000);
}

void CardEditor::show_document(Document* document) {
    if (m_document != nullptr) {
        m_document->disconnect(this);
        m_document->focus().disconnect(this);
    }
    m_document = document;
    m_block.reset();
    m_canvas->begin_anew();
    m_region->show_document(document);
    if (document == nullptr) return m_canvas->show_picture({});
    connect(document, &Document::shown_made, this, &CardEditor::show_block);
    connect(&document->focus(), &Focus::place_changed, this, [this] {
        if (!m_block) return;
        follow_place();
        m_canvas->set_cursor_cell(m_canvas->cursor_cell());
    });
    show_block();
}

void CardEditor::show_mode(CardMode mode, std::size_t layer) {
    m_mode = mode;
    m_layer = layer;
    const QSignalBlocker quiet(m_modes);
    m_modes->setCurrentIndex(std::max(0, m_modes->findData(data_of(mode, layer))));
    show_block();
}

void CardEditor::show_block() {
    if (m_document == nullptr) return;
    const Cloth& shown = m_document->shown();
    if (!shown.block) {
        m_block.reset();
        m_region->show_block(nullptr);
        m_canvas->set_empty_text(shown.error ? tr("This block cannot be made: %1").arg(QString::fromStdString(shown.error->text())) : tr("The block is being made …"));
        return m_canvas->show_picture({});
    }
    const bool is_same_grid = m_block && m_block->t() == shown.block->t() && m_block->p() == shown.block->p();
    m_block = shown.block;
    if (!is_same_grid || m_layers == 0) {
        m_layers = layer_count(*m_block);
        list_modes();
    }
    m_modes->setToolTip(tr("What is shown of the block: %1 × %2").arg(tr("%n pick(s)", nullptr, static_cast<int>(m_block->picks())), tr("%n end(s)", nullptr, static_cast<int>(m_block->ends()))));
    const std::uint64_t wanted = ++m_wanted;
    if (m_mode == CardMode::card) return show_picture(CellPicture(shown.card), m_mode);
    in_background(
        this, [design = m_document->design(), block = m_block, mode = m_mode, layer = m_layer] { return block_picture(design, *block, mode, layer); },
        [this, wanted, mode = m_mode](const QImage& image) {
            if (wanted == m_wanted) show_picture(CellPicture(image), mode);
        });
}

void CardEditor::show_picture(CellPicture picture, CardMode mode) {
    m_shown_mode = mode;
    m_canvas->set_can_stroke(mode == CardMode::card);
    m_canvas->show_picture(std::move(picture), m_times_rows->value(), m_times_columns->value());
    m_canvas->set_labels(labels());
    m_region->show_block(mode == CardMode::card ? m_block : nullptr);
    m_legend->setVisible(mode == CardMode::face_floats || mode == CardMode::back_floats);
    follow_place();
}

/// The cursor stays on the same yarns, whatever is shown of them.
void CardEditor::follow_place() {
    const auto& place = m_document->focus().place();
    if (!place) return;
    const auto& cursor = m_canvas->cursor_cell();
    if (cursor && cell_of(place_of(*cursor)) == cell_of(*place)) return;  // there already, in one of the repeats
    m_canvas->set_cursor_cell(cell_of(*place));
}

GridLabels CardEditor::labels() const {
    const BlockPtr block = m_block;
    if (m_shown_mode != CardMode::card) {
        const auto every = [](std::size_t) { return false; };
        return {tr("picks"), tr("ends"), [block](std::size_t row) { return block->first_pick(row); },
                [block](std::size_t column) { return block->first_end(column); }, every, every};
    }
    // Where each stack is one crossing there is nothing to set apart.
    const bool has_stacks = block->picks() > block->rows() || block->ends() > block->columns();
    const auto begins = [block, has_stacks](auto line_of, auto first_of, std::size_t count) {
        return [block, has_stacks, line_of, first_of, count](std::size_t number) {
            return has_stacks && (number % count == 0 || (block.get()->*first_of)((block.get()->*line_of)(number % count)) == number % count);
        };
    };
    const auto same = [](std::size_t number) { return number; };
    return {tr("picks"), tr("ends"), same, same, begins(&Block::row_of_pick, &Block::first_pick, block->picks()),
            begins(&Block::column_of_end, &Block::first_end, block->ends())};
}

CardPlace CardEditor::place_of(const GridCell& cell) const {
    if (m_shown_mode == CardMode::card) return {cell.row % m_block->picks(), cell.column % m_block->ends()};
    return {m_block->first_pick(cell.row % m_block->rows()), m_block->first_end(cell.column % m_block->columns())};
}

GridCell CardEditor::cell_of(const CardPlace& place) const {
    const std::size_t pick = std::min(place.pick, m_block->picks() - 1), end = std::min(place.end, m_block->ends() - 1);
    if (m_shown_mode == CardMode::card) return {pick, end};
    return {m_block->row_of_pick(pick), m_block->column_of_end(end)};
}

// ---- What a person does ----

void CardEditor::flip(const std::vector<GridCell>& cells) {
    if (m_document == nullptr || !m_block) return;
    std::vector<CardPlace> places;
    for (const GridCell& cell : cells) places.push_back(place_of(cell));
    const FlippedStroke flipped = flip_stroke(*m_document, places);
    if (Status made = m_document->perform(flipped.step); !made) Q_EMIT told(QString::fromStdString(made.error().text()));
    if (flipped.refused.empty()) {
        QToolTip::hideText();
        if (flipped.flipped > 0) Q_EMIT told(flipped.step.text);
    } else {
        std::vector<GridCell> refused;
        for (const RefusedCrossing& one : flipped.refused) refused.push_back(cell_of(one.place));
        explain(refused, QString::fromStdString(flipped.refused.front().reason.text()), flipped.flipped);
    }
    m_document->focus().go_to(places.back());
}

void CardEditor::explain(const std::vector<GridCell>& refused, const QString& why, std::size_t flipped) {
    QString words = why;
    if (refused.size() > 1 || flipped > 0) words = tr("%1 of %n crossing(s) stay as they are. The first: %2", nullptr, static_cast<int>(refused.size() + flipped)).arg(refused.size()).arg(why);
    m_canvas->mark_refused(refused);
    QToolTip::showText(m_canvas->mapToGlobal(m_canvas->mapping().box(refused.front()).bottomRight().toPoint()), as_plain(words), m_canvas, {}, 8000);
    Q_EMIT told(words);
}

void CardEditor::tell_of(const std::optional<GridCell>& cell) {
    const QString chosen = m_region->words();
    if (!cell || !m_block) return told(chosen);
    const CardPlace place = place_of(*cell);
    const PlacedStack at = stack_at(*m_block, place.pick, place.end);
    const QString side = m_block->weft_over(place.pick, place.end) ? tr("weft over (white)") : tr("end lifted (black)");
    const QString stack = QString::fromStdString(to_text(at.stack, at.first_pick, at.first_end));
    QString words = tr("Pick %1, end %2").arg(place.pick + 1).arg(place.end + 1);
    if (m_shown_mode == CardMode::card) words += ": " + side;
    if (at.stack.height() <= 24) words += tr(" · stack from below: %1").arg(stack);
    if (!chosen.isEmpty()) words += " · " + chosen;
    Q_EMIT told(words);
}

void CardEditor::offer(const GridCell& cell, const QPoint& where) {
    if (m_document == nullptr || !m_block) return;
    const CardPlace place = place_of(cell);
    m_document->focus().go_to(place);
    QMenu menu;
    menu.addAction(tr("Flip pick %1, end %2").arg(place.pick + 1).arg(place.end + 1), this, [&] { flip({cell_of(place)}); })->setEnabled(m_shown_mode == CardMode::card);
    menu.addSeparator();
    menu.addAction(tr("Section along end %1 (warp slice)").arg(place.end + 1), this, [&] { Q_EMIT slice_wanted(System::weft, place); });
    menu.addAction(tr("Section along pick %1 (weft slice)").arg(place.pick + 1), this, [&] { Q_EMIT slice_wanted(System::warp, place); });
    if (m_shown_mode == CardMode::card) {
        menu.addSeparator();
        m_region->fill_menu(*menu.addMenu(tr("Region")));
    }
    menu.exec(where);
}

}  // namespace weave::studio
