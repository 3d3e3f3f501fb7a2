#include <studio/editors/card_region.hpp>

#include <weave/block/card_part.hpp>

#include <QAction>
#include <QActionGroup>
#include <QClipboard>
#include <QGuiApplication>
#include <QMenu>

#include <algorithm>
#include <studio/commands/set_crossings.hpp>
#include <studio/editors/card_clipboard.hpp>
#include <studio/jobs/background.hpp>
#include <utility>

namespace weave::studio {

namespace {

/// Unlike the card below it, whose squares are black and white.
constexpr QRgb floating_lifted = 0xff00395c, floating_weft = 0xffffe9b8;

QImage picture_of(const CardImage& part) {
    QImage image(static_cast<int>(part.ends()), static_cast<int>(part.picks()), QImage::Format_RGB32);
    for (std::size_t pick = 0; pick < part.picks(); ++pick) {
        auto* line = reinterpret_cast<QRgb*>(image.scanLine(static_cast<int>(pick)));
        for (std::size_t end = 0; end < part.ends(); ++end) line[end] = part.weft_over(pick, end) ? floating_weft : floating_lifted;
    }
    return image;
}

}  // namespace

CardRegion::CardRegion(GridCanvas& canvas, QObject* parent) : QObject(parent), m_canvas(canvas) {
    make_actions();
    connect(&m_canvas, &GridCanvas::region_changed, this, [this] {
        follow_canvas();
        if (m_canvas.region()) Q_EMIT told(words());
    });
    connect(&m_canvas, &GridCanvas::floating_moved, this, &CardRegion::judge_floating);
    connect(&m_canvas, &GridCanvas::floating_ended, this, [this](bool is_put_down) {
        follow_canvas();
        if (is_put_down) put_down(*m_canvas.region());
    });
    connect(QGuiApplication::clipboard(), &QClipboard::dataChanged, this, &CardRegion::follow_canvas);
    follow_canvas();
}

QAction* CardRegion::make(const QString& name, const QString& text, const QKeySequence& keys, std::function<void()> deed) {
    auto* action = new QAction(text, this);
    action->setObjectName(name);
    action->setShortcut(keys);
    action->setShortcutContext(Qt::WidgetShortcut);
    action->setShortcutVisibleInContextMenu(true);
    connect(action, &QAction::triggered, this, std::move(deed));
    m_canvas.addAction(action);
    return action;
}

QAction* CardRegion::make_tool(const QString& name, const QString& text, const QString& tip, const QKeySequence& keys, GridTool tool) {
    QAction* action = make(name, text, keys, [this, tool] { m_canvas.set_tool(tool); });
    action->setCheckable(true);
    action->setWhatsThis(tr("%1 (%2)").arg(tip, keys.toString(QKeySequence::NativeText)));
    action->setToolTip(action->whatsThis());
    m_tools.push_back(action);
    return action;
}

void CardRegion::make_actions() {
    auto* group = new QActionGroup(this);
    group->addAction(make_tool("choose-tool", tr("Choose"), tr("Choose a region of the card: drag over it, or Shift and the arrows"), Qt::Key_S, GridTool::choose));
    group->addAction(make_tool("flip-tool", tr("Flip"), tr("A click or a line flips crossings"), Qt::Key_D, GridTool::stroke));
    connect(&m_canvas, &GridCanvas::tool_changed, this, [this] { m_tools[m_canvas.tool() == GridTool::choose ? 0 : 1]->setChecked(true); });
    m_tools[1]->setChecked(true);
    m_choose_all = make("choose-all", tr("Choose all"), QKeySequence::SelectAll, [this] { m_canvas.choose_all(); });
    m_copies.push_back(make("copy-region", tr("Copy"), QKeySequence::Copy, [this] { copy(); }));
    m_paste = make("paste-region", tr("Paste"), QKeySequence::Paste, [this] { paste(); });
    m_copies.push_back(make("duplicate-region", tr("Duplicate, to be moved"), Qt::CTRL | Qt::Key_D, [this] { duplicate(); }));
    m_copies.push_back(make("cut-region", tr("Cut"), QKeySequence::Cut, [this] { Q_EMIT told(tr("Nothing can be cut out of a card: cloth has a crossing everywhere. Copy the region (Ctrl+C), or fill it")); }));
    const auto change = [&](const QString& name, const QString& text, const QString& step, const Wish& wish) {
        m_changes.push_back(make(name, text, {}, [this, step, wish] { ask(step.arg(words_of(*m_canvas.region())), *m_canvas.region(), wish); }));
    };
    change("lift-all", tr("Lift all ends (black)"), tr("Lift all ends of %1"), [](const CardImage& now) { return one_sided(now.picks(), now.ends(), false); });
    change("lift-none", tr("Lift no end (white)"), tr("Lift no end of %1"), [](const CardImage& now) { return one_sided(now.picks(), now.ends(), true); });
    change("invert", tr("Invert"), tr("Invert %1"), inverted);
    change("mirror-across", tr("Mirror left and right"), tr("Mirror %1, left and right"), mirrored_across);
    change("mirror-along", tr("Mirror top and bottom"), tr("Mirror %1, top and bottom"), mirrored_along);
    m_fill = make("fill", tr("Fill with what was copied"), {}, [this] { fill(); });
}

void CardRegion::fill_menu(QMenu& menu) const {
    menu.addActions({m_copies[0], m_paste, m_copies[1]});
    menu.addSeparator();
    menu.addActions(m_changes);
    menu.addAction(m_fill);
    menu.addSeparator();
    menu.addAction(m_choose_all);
}

void CardRegion::show_document(Document* document) {
    if (m_document != nullptr) m_document->focus().disconnect(this);
    m_document = document;
    m_waiting.clear();
    show_block(nullptr);
    // A region of another block would be another part of the cloth.
    if (document != nullptr) connect(&document->focus(), &Focus::block_changed, this, [this] {
        m_waiting.clear();
        m_canvas.let_go();
    });
}

void CardRegion::show_block(BlockPtr block) {
    m_block = std::move(block);
    if (!m_block) m_canvas.set_tool(GridTool::stroke), m_canvas.let_go();
    follow_canvas();
    judge_floating();
    go_on();
}

void CardRegion::follow_canvas() {
    const bool has_region = m_block && m_canvas.region(), floats = m_block && m_canvas.floating_region();
    for (QAction* action : std::as_const(m_copies)) action->setEnabled(has_region || floats);
    for (QAction* action : std::as_const(m_changes)) action->setEnabled(has_region);
    m_paste->setEnabled(m_block && clipboard_has_part());
    m_fill->setEnabled(has_region && clipboard_has_part());
    m_choose_all->setEnabled(m_block != nullptr);
    QAction* choose = m_tools[0];
    choose->setEnabled(m_block != nullptr);
    choose->setToolTip(m_block ? choose->whatsThis() : tr("Regions are chosen where the list shows the card: only there is a square one crossing"));
}

QString CardRegion::words() const {
    const auto& region = m_canvas.floating_region() ? m_canvas.floating_region() : m_canvas.region();
    return region && m_block ? tr("chosen: %1 (%2 × %3)").arg(words_of(*region)).arg(region->rows).arg(region->columns) : QString();
}

QString CardRegion::words_of(const GridRegion& region) const {
    const auto lines = [](std::size_t first, std::size_t count, std::size_t all) {
        const QString from = QString::number(first % all + 1);
        return count == 1 ? from : tr("%1–%2").arg(from).arg((first + count - 1) % all + 1);
    };
    return tr("picks %1, ends %2").arg(lines(region.first.row, region.rows, m_block->picks()), lines(region.first.column, region.columns, m_block->ends()));
}

CardWish CardRegion::wish_at(const GridRegion& region, CardImage pixels) const {
    return {region.first.row % m_block->picks(), region.first.column % m_block->ends(), std::move(pixels)};
}

/// The squares of crossings in that repeat of the card in which the region lies.
std::vector<GridCell> CardRegion::cells_of(const std::vector<Flip>& crossings, const GridRegion& region) const {
    const auto line = [](std::size_t first, std::size_t wanted, std::size_t all) { return first + (wanted + all - first % all) % all; };
    std::vector<GridCell> cells;
    for (const Flip& one : crossings) cells.push_back({line(region.first.row, one.pick, m_block->picks()), line(region.first.column, one.end, m_block->ends())});
    return cells;
}

bool CardRegion::is_small(const GridRegion& region) {
    if (region.rows * region.columns <= most_crossings) return true;
    Q_EMIT told(tr("%L1 crossings are too many at once: choose a region of at most %L2").arg(region.rows * region.columns).arg(most_crossings));
    return false;
}

void CardRegion::tell_error(const Error& error) {
    Q_EMIT told(QString::fromStdString(error.text()));
}

// ---- Copying, and putting down ----

/// What floats, else what is chosen, as it is seen.
CardImage CardRegion::chosen_part() const {
    if (m_canvas.floating_region()) return m_floating;
    const GridRegion& region = *m_canvas.region();
    return part_of(m_document->shown().card->card, region.first.row % m_block->picks(), region.first.column % m_block->ends(), region.rows, region.columns);
}

void CardRegion::copy() {
    if (m_canvas.region() && !is_small(*m_canvas.region())) return;
    const CardImage part = chosen_part();
    if (Status put = put_on_clipboard(part); !put) return tell_error(put.error());
    Q_EMIT told(tr("A region of %1 picks × %2 ends is on the clipboard").arg(part.picks()).arg(part.ends()));
}

/// What floats already is put down, and floats on.
void CardRegion::duplicate() {
    if (const auto region = m_canvas.floating_region()) return put_down(*region);
    if (is_small(*m_canvas.region())) let_float(chosen_part(), m_canvas.region()->first);
}

void CardRegion::paste() {
    auto part = part_on_clipboard();
    if (!part) return tell_error(part.error());
    const GridCell at = m_canvas.region() ? m_canvas.region()->first : m_canvas.cursor_cell().value_or(GridCell{});
    if (is_small({at, part->picks(), part->ends()})) let_float(*std::move(part), at);
}

void CardRegion::fill() {
    auto part = part_on_clipboard();
    if (!part) return tell_error(part.error());
    const GridRegion region = *m_canvas.region();
    ask(tr("Fill %1").arg(words_of(region)), region, [part = *std::move(part)](const CardImage& now) { return part_of(part, 0, 0, now.picks(), now.ends()); });
}

void CardRegion::let_float(CardImage part, GridCell first) {
    m_floating = std::move(part);
    m_canvas.set_tool(GridTool::choose);
    m_canvas.show_floating(picture_of(m_floating), first);
}

/// Marks what of the floating part cannot be where it is now. While that is found out it may have moved on.
void CardRegion::judge_floating() {
    const auto region = m_canvas.floating_region();
    if (!region || !m_block) return;
    follow_canvas();
    m_has_moved = true;
    if (std::exchange(m_is_judging, true)) return;
    m_has_moved = false;
    in_background(
        this, [block = m_block, wish = wish_at(*region, part_of(m_floating, 0, 0, region->rows, region->columns))]() -> Result<GrantedWish> { return grant(*block, wish); },
        [this, block = m_block, region](Result<GrantedWish> granted) {
            m_is_judging = false;
            if (m_has_moved || block != m_block) return judge_floating();
            if (!granted) return tell_error(granted.error());
            if (m_canvas.floating_region() != region) return;
            m_canvas.mark_floating(cells_of(granted->refused, *region));
            Q_EMIT told(tr("%1: %2 crossings change, %3 cannot. Enter or a click beside it puts it down, Esc drops it").arg(words()).arg(granted->flips.size()).arg(granted->refused.size()));
        });
}

void CardRegion::put_down(const GridRegion& region) {
    ask(tr("Paste on %1").arg(words_of(region)), region, [part = m_floating](const CardImage& now) { return part_of(part, 0, 0, now.picks(), now.ends()); });
}

// ---- Changing the card ----

void CardRegion::ask(const QString& text, const GridRegion& region, Wish wish) {
    if (!is_small(region)) return;
    m_waiting.push_back({++m_asked, text, region, std::move(wish)});
    go_on();
}

/// Begins with what was asked for first, once the card of the design as it stands is there.
void CardRegion::go_on() {
    if (m_is_busy || m_waiting.empty() || !m_block || !m_document->shown_is_current()) return;
    m_is_busy = true;
    const Deed deed = m_waiting.front();
    in_background(
        this,
        [deed, block = m_block, card = m_document->shown().card, where = wish_at(deed.region, {})]() -> Result<GrantedWish> {
            const CardImage now = part_of(card->card, where.pick, where.end, deed.region.rows, deed.region.columns);
            return grant(*block, {where.pick, where.end, deed.wish(now)});
        },
        [this, deed, revision = m_document->revision()](Result<GrantedWish> granted) {
            m_is_busy = false;
            const bool is_wanted = !m_waiting.empty() && m_waiting.front().number == deed.number;
            if (!is_wanted || m_document->revision() != revision) return go_on();  // on the card that there is by now
            m_waiting.pop_front();
            if (granted) end(deed, *granted);
            else tell_error(granted.error());
            go_on();
        });
}

void CardRegion::end(const Deed& deed, const GrantedWish& granted) {
    if (Status made = m_document->perform(set_crossings(m_document->design(), m_document->shown_block(), granted.flips, deed.text)); !made)
        return tell_error(made.error());
    if (!granted.refused.empty()) return refused(cells_of(granted.refused, deed.region), QString::fromStdString(granted.reason), granted.flips.size());
    Q_EMIT told(granted.flips.empty() ? tr("%1: it is so already").arg(deed.text) : deed.text);
}

}  // namespace weave::studio
