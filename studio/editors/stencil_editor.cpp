#include <studio/editors/stencil_editor.hpp>

#include <weave/block/stencil_edit.hpp>
#include <studio/editors/stencil_dialogs.hpp>
#include <studio/jobs/background.hpp>

#include <QFileDialog>
#include <QHBoxLayout>
#include <QSplitter>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>

namespace weave::studio {

namespace {

/// Stacks are counted for the palette where that takes no time.
constexpr std::size_t most_counted = 1000000;

}  // namespace

StencilEditor::StencilEditor(QWidget* parent)
    : QWidget(parent),
      m_canvas(new StencilCanvas(this)),
      m_palette(new StencilPalette(this)),
      m_tools(new QActionGroup(this)),
      m_size(new QLabel(this)),
      m_trouble(new QLabel(this)) {
    auto* split = new QSplitter(Qt::Horizontal, this);
    split->addWidget(m_canvas);
    split->addWidget(m_palette);
    split->setStretchFactor(0, 1);
    split->setChildrenCollapsible(false);
    m_palette->setMinimumWidth(fontMetrics().averageCharWidth() * 20);
    split->setSizes({600, 200});
    m_trouble->setObjectName("stencil_trouble");
    m_trouble->setWordWrap(true);
    m_trouble->setTextFormat(Qt::PlainText);
    m_trouble->setMargin(4);
    m_trouble->setStyleSheet("background: #fdf0e6; color: #7a3300;");
    auto* rows = new QVBoxLayout(this);
    rows->setContentsMargins(0, 0, 0, 0);
    rows->setSpacing(2);
    rows->addWidget(make_tool_row());
    rows->addWidget(m_trouble);
    rows->addWidget(split, 1);
    setFocusProxy(m_canvas);
    connect(m_canvas, &StencilCanvas::status, this, &StencilEditor::status);
    connect(m_canvas, &StencilCanvas::block_chosen, this,
            [this](std::uint16_t block) { m_palette->choose(block); });
    connect(m_canvas, &StencilCanvas::painted, this,
            [this](const std::shared_ptr<const StencilMap>& map, const QString& what) {
                put({m_operation.of, map}, what);
            });
    connect(m_palette, &StencilPalette::chosen_changed, this, &StencilEditor::choose_entry);
    connect(m_palette, &StencilPalette::add_wanted, this, &StencilEditor::add_block);
    connect(m_palette, &StencilPalette::remove_wanted, this, &StencilEditor::remove_entry);
    connect(m_palette, &StencilPalette::move_wanted, this, &StencilEditor::move_entry);
    m_tools->actions().front()->trigger();
    show_all();
}

QWidget* StencilEditor::make_tool_row() {
    // Two rows, so that all fits where the editor is narrow.
    auto* rows = new QWidget(this);
    auto* column = new QVBoxLayout(rows);
    column->setContentsMargins(4, 2, 4, 2);
    column->setSpacing(0);
    const auto add_row = [&] {
        auto* made = new QWidget(rows);
        auto* line = new QHBoxLayout(made);
        line->setContentsMargins(0, 0, 0, 0);
        line->setSpacing(2);
        column->addWidget(made);
        return made;
    };
    QWidget* const brushes = add_row();
    QWidget* const row = add_row();
    auto* layout = static_cast<QHBoxLayout*>(row->layout());
    make_tool(brushes, StencilTool::pencil, "pencil", tr("Pencil"), Qt::Key_P);
    make_tool(brushes, StencilTool::line, "line", tr("Line"), Qt::Key_L);
    make_tool(brushes, StencilTool::rectangle, "rectangle", tr("Rectangle"), Qt::Key_R);
    make_tool(brushes, StencilTool::flood, "flood", tr("Fill"), Qt::Key_G);
    make_tool(brushes, StencilTool::choose, "choose", tr("Choose block"), Qt::Key_I);
    static_cast<QHBoxLayout*>(brushes->layout())->addStretch(1);
    make_button(row, "size", tr("Size …"), tr("Change the size of the picture, in stacks"),
                [this] { ask_size(); });
    make_button(row, "load", tr("Load picture …"), tr("Take a PNG, TIFF or BMP as the picture"),
                [this] { choose_picture(); });
    layout->addStretch(1);
    layout->addWidget(m_size);
    make_action(row, "zoom_out", tr("−"), tr("Zoom out"), Qt::Key_Minus);
    make_action(row, "zoom_in", tr("+"), tr("Zoom in"), Qt::Key_Plus);
    make_action(row, "fit", tr("Fit"), tr("Show the whole picture"), Qt::Key_F);
    connect(findChild<QAction*>("zoom_out"), &QAction::triggered, m_canvas, &StencilCanvas::zoom_out);
    connect(findChild<QAction*>("zoom_in"), &QAction::triggered, m_canvas, &StencilCanvas::zoom_in);
    connect(findChild<QAction*>("fit"), &QAction::triggered, m_canvas, &StencilCanvas::fit);
    return rows;
}

QAction* StencilEditor::make_action(QWidget* row, const QString& name, const QString& text,
                                    const QString& tip, const QKeySequence& keys) {
    auto* action = new QAction(text, this);
    action->setObjectName(name);
    action->setShortcut(keys);
    action->setShortcutContext(Qt::WidgetShortcut);
    action->setToolTip(tr("%1 (%2)").arg(tip, keys.toString(QKeySequence::NativeText)));
    m_canvas->addAction(action);
    auto* button = new QToolButton(row);
    button->setDefaultAction(action);
    button->setAutoRaise(true);
    row->layout()->addWidget(button);
    return action;
}

void StencilEditor::make_tool(QWidget* row, StencilTool tool, const QString& name, const QString& text,
                              const QKeySequence& keys) {
    QAction* action = make_action(row, name, text, text, keys);
    action->setCheckable(true);
    connect(action, &QAction::triggered, this, [this, tool] { m_canvas->set_tool(tool); });
    m_tools->addAction(action);
}

void StencilEditor::make_button(QWidget* row, const QString& name, const QString& text, const QString& tip,
                                const std::function<void()>& what) {
    auto* button = new QToolButton(row);
    button->setObjectName(name);
    button->setText(text);
    button->setToolTip(tip);
    button->setAutoRaise(true);
    connect(button, &QToolButton::clicked, this, what);
    row->layout()->addWidget(button);
}

void StencilEditor::show_operation(const StencilOperation& operation) {
    m_operation = operation;
    show_all();
}

void StencilEditor::set_blocks(std::vector<BlockChoice> blocks) {
    m_blocks = std::move(blocks);
    show_all();
}

/// What a gesture made: shown at once, and told.
void StencilEditor::put(StencilOperation operation, const QString& what) {
    m_operation = std::move(operation);
    show_all();
    Q_EMIT edited(m_operation, what);
}

const BlockChoice* StencilEditor::choice_of(const std::string& name) const {
    const auto found = std::ranges::find(m_blocks, QString::fromStdString(name), &BlockChoice::name);
    return found == m_blocks.end() ? nullptr : &*found;
}

QString StencilEditor::obstacle(const std::vector<std::string>& names, std::size_t rows,
                                std::size_t columns) const {
    std::vector<BlockGrid> grids;
    std::vector<const BlockGrid*> list;
    for (const std::string& name : names) {
        const BlockChoice* choice = choice_of(name);
        if (choice == nullptr) return tr("the design has no block '%1'").arg(QString::fromStdString(name));
        if (!choice->reason.isEmpty()) return choice->reason;
        if (choice->t.empty() || choice->p.empty())
            return tr("'%1' cannot be made, so its size is not known").arg(choice->name);
        grids.emplace_back(choice->t, choice->p);
    }
    for (const BlockGrid& grid : grids) list.push_back(&grid);
    const Status fits = check_stencil_counts(list, rows, columns, names);
    return fits ? QString() : QString::fromStdString(fits.error().text());
}

QString StencilEditor::obstacle_beside_first(const std::string& name) const {
    std::vector<std::string> names{name};
    if (!m_operation.of.empty() && m_operation.of.front() != name)
        names.insert(names.begin(), m_operation.of.front());
    return obstacle(names, has_map() ? m_operation.map->rows : 1, has_map() ? m_operation.map->columns : 1);
}

std::vector<BlockChoice> StencilEditor::choices_beside_first() const {
    std::vector<BlockChoice> choices = m_blocks;
    for (BlockChoice& choice : choices) choice.reason = obstacle_beside_first(choice.name.toStdString());
    return choices;
}

void StencilEditor::show_all() {
    const auto& of = m_operation.of;
    std::vector<PaletteEntry> entries;
    std::vector<QColor> colours;
    std::vector<QString> names;
    std::vector<std::size_t> counts;
    const bool counted = has_map() && m_operation.map->blocks.size() <= most_counted;
    if (counted) counts = stacks_of_blocks(*m_operation.map, of.size());
    for (std::size_t k = 0; k < of.size(); ++k) {
        const BlockChoice* choice = choice_of(of[k]);
        colours.push_back(StencilPalette::colour_of(k));
        names.push_back(QString::fromStdString(of[k]));
        entries.push_back({names.back(), choice != nullptr ? choice->thumbnail : QPixmap(), colours.back(),
                           obstacle_beside_first(of[k]), counted ? std::optional(counts[k]) : std::nullopt});
    }
    m_palette->show_entries(entries);
    m_palette->show_choices(choices_beside_first());
    m_canvas->set_names(names);
    m_canvas->show_map(has_map() ? m_operation.map : std::make_shared<const StencilMap>(), colours);
    m_size->setText(
        has_map() ? tr("%L1 rows × %L2 columns").arg(m_operation.map->rows).arg(m_operation.map->columns)
                  : QString());
    const QString trouble = of.empty()  ? tr("Add a block to begin with.")
                            : has_map() ? obstacle(of, m_operation.map->rows, m_operation.map->columns)
                                        : QString();
    m_trouble->setText(trouble);
    m_trouble->setVisible(!trouble.isEmpty());
    choose_entry(m_palette->chosen());
}

void StencilEditor::choose_entry(int entry) {
    const bool none = entry < 0 || static_cast<std::size_t>(entry) >= m_operation.of.size();
    m_canvas->set_block(static_cast<std::uint16_t>(none ? 0 : entry));
    m_canvas->set_obstacle(none ? tr("choose a block at the side first")
                                : obstacle_beside_first(m_operation.of[static_cast<std::size_t>(entry)]));
}

// ---- palette

void StencilEditor::add_block(const QString& name) {
    const std::string block = name.toStdString();
    if (const QString why = obstacle_beside_first(block); !why.isEmpty())
        return m_canvas->refuse(why, m_canvas->rect().center());
    if (const auto known = std::ranges::find(m_operation.of, block); known != m_operation.of.end())
        return m_palette->choose(static_cast<int>(known - m_operation.of.begin()));
    if (m_operation.of.size() >= most_stencilled)
        return m_canvas->refuse(tr("a stencil takes no more blocks"), m_canvas->rect().center());
    StencilOperation operation = m_operation;
    operation.of.push_back(block);
    if (!has_map()) {  // four repeats each way of the first block, to begin with
        const BlockChoice* choice = choice_of(block);
        const std::size_t rows = std::min<std::size_t>(4 * choice->t.size(), 1000),
                          columns = std::min<std::size_t>(4 * choice->p.size(), 1000);
        operation.map = std::make_shared<const StencilMap>(
            StencilMap{rows, columns, std::vector<std::uint16_t>(rows * columns)});
    }
    put(std::move(operation), tr("Add %1 to the stencil").arg(name));
    m_palette->choose(static_cast<int>(m_operation.of.size()) - 1);
}

void StencilEditor::remove_entry(int entry) {
    if (entry < 0 || static_cast<std::size_t>(entry) >= m_operation.of.size()) return;
    if (m_operation.of.size() == 1)
        return m_canvas->refuse(tr("a stencil needs at least one block; add another one first"),
                                m_canvas->rect().center());
    StencilOperation operation = m_operation;
    const auto gone = static_cast<std::size_t>(entry);
    const QString name = QString::fromStdString(operation.of[gone]);
    operation.of.erase(operation.of.begin() + entry);
    std::size_t lost = 0;
    if (has_map()) {
        std::vector<std::uint16_t> numbers(m_operation.of.size());
        for (std::size_t k = 0; k < numbers.size(); ++k)
            numbers[k] = static_cast<std::uint16_t>(k < gone ? k : k == gone ? 0 : k - 1);
        lost = stacks_of_blocks(*m_operation.map, m_operation.of.size())[gone];
        operation.map = std::make_shared<const StencilMap>(with_blocks_renumbered(*m_operation.map, numbers));
    }
    const QString heir = QString::fromStdString(operation.of.front());
    put(std::move(operation), tr("Remove %1 from the stencil").arg(name));
    if (lost > 0) Q_EMIT status(tr("%L1 stacks that were %2 are %3 now").arg(lost).arg(name, heir));
}

void StencilEditor::move_entry(int entry, int step) {
    const int other = entry + step;
    if (entry < 0 || other < 0 || static_cast<std::size_t>(std::max(entry, other)) >= m_operation.of.size())
        return;
    StencilOperation operation = m_operation;
    const auto from = static_cast<std::size_t>(entry), to = static_cast<std::size_t>(other);
    std::swap(operation.of[from], operation.of[to]);
    if (has_map()) {
        std::vector<std::uint16_t> numbers(operation.of.size());
        for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = static_cast<std::uint16_t>(k);
        std::swap(numbers[from], numbers[to]);
        operation.map = std::make_shared<const StencilMap>(with_blocks_renumbered(*m_operation.map, numbers));
    }
    put(std::move(operation), tr("Reorder the stencil's blocks"));
    m_palette->choose(other);
}

// ---- size and pictures

void StencilEditor::ask_size() {
    if (!has_map()) return m_canvas->refuse(tr("add a block first"), m_canvas->rect().center());
    auto* dialog = new StencilSizeDialog(m_operation.map->rows, m_operation.map->columns, this);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    connect(dialog, &QDialog::accepted, this, [this, dialog] {
        const auto fill = static_cast<std::uint16_t>(std::max(0, m_palette->chosen()));
        Result<StencilMap> map = resized(*m_operation.map, dialog->rows(), dialog->columns(),
                                         dialog->rows_kept(), dialog->columns_kept(), fill);
        QString why = map ? obstacle(m_operation.of, map->rows, map->columns)
                          : QString::fromStdString(map.error().text());
        if (!why.isEmpty()) return m_canvas->refuse(why, m_canvas->rect().center());
        if (*map == *m_operation.map) return;
        put({m_operation.of, std::make_shared<const StencilMap>(std::move(map).value())},
            tr("Resize the stencil"));
    });
    dialog->open();
}

void StencilEditor::choose_picture() {
    const std::size_t asked = ++m_reading;
    const QString path = QFileDialog::getOpenFileName(this, tr("Picture for the stencil"), {},
                                                      tr("Pictures (*.png *.tif *.tiff *.bmp)"));
    if (!path.isEmpty() && asked == m_reading) load_picture(path);
}

void StencilEditor::drop_questions() {
    ++m_reading;
    for (QDialog* dialog : findChildren<QDialog*>(Qt::FindDirectChildrenOnly)) dialog->reject();
}

void StencilEditor::make_beside(std::function<std::function<void()>()> work) {
    in_background(this, std::move(work), [this, reading = ++m_reading](const std::function<void()>& done) {
        if (m_reading == reading) done();
    });
}

void StencilEditor::load_picture(const QString& path) {
    Q_EMIT status(tr("reading %1 …").arg(path));
    make_beside([this, path] {
        return [this, picture = read_coloured_picture(path.toStdString())] {
            if (!picture)
                return m_canvas->refuse(QString::fromStdString(picture.error().text()), m_canvas->rect().center());
            Q_EMIT status({});
            ask_blocks(*picture);
        };
    });
}

void StencilEditor::ask_blocks(const ColouredPicture& picture) {
    const std::size_t rows = picture.image->rows, columns = picture.image->columns;
    std::vector<BlockChoice> choices = m_blocks;
    for (BlockChoice& choice : choices) choice.reason = obstacle({choice.name.toStdString()}, rows, columns);
    const auto why = [this, choices, rows, columns](const std::vector<std::size_t>& list) {
        std::vector<std::string> names;
        for (const std::size_t k : list) names.push_back(choices[k].name.toStdString());
        return obstacle(names, rows, columns);
    };
    auto* dialog = new PictureMapDialog(picture.colours, choices, why, this);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    connect(dialog, &QDialog::accepted, this, [this, dialog, picture] { take_picture(picture, dialog->blocks()); });
    dialog->open();
}

void StencilEditor::take_picture(const ColouredPicture& picture, const std::vector<std::string>& blocks) {
    make_beside([this, picture, palette = palette_of(picture, blocks)] {
        return [this, of = palette.blocks, map = stencil_map(*picture.image, palette.numbers)] {
            if (!map) return m_canvas->refuse(QString::fromStdString(map.error().text()), m_canvas->rect().center());
            put({of, std::make_shared<const StencilMap>(*map)}, tr("Load a picture into the stencil"));
        };
    });
}

}  // namespace weave::studio
