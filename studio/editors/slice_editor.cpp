#include <studio/editors/slice_editor.hpp>

#include <QHBoxLayout>
#include <QPushButton>
#include <QToolBar>
#include <QToolButton>
#include <QVBoxLayout>

namespace weave::studio {

SliceEditor::SliceEditor(QWidget* parent)
    : QWidget(parent),
      m_canvas(new SliceEditCanvas(this)),
      m_reader(new SliceReader(this)),
      m_pages(new QStackedWidget(this)) {
    m_tool_row = make_tool_row();
    m_begin_row = make_begin_row();
    auto* page = new QWidget(this);
    auto* rows = new QVBoxLayout(page);
    rows->setContentsMargins(0, 0, 0, 0);
    rows->setSpacing(2);
    rows->addWidget(m_tool_row);
    rows->addWidget(m_begin_row);
    rows->addWidget(m_canvas, 1);
    m_pages->addWidget(page);
    m_pages->addWidget(m_reader);
    auto* all = new QVBoxLayout(this);
    all->setContentsMargins(0, 0, 0, 0);
    all->addWidget(m_pages);
    connect(m_canvas, &SliceEditCanvas::edited, this, &SliceEditor::edited);
    connect(m_canvas, &SliceCanvas::status, this, &SliceEditor::status);
    connect(m_reader, &SliceReader::status, this, &SliceEditor::status);
    connect(m_reader, &SliceReader::flip_wanted, this, &SliceEditor::flip_wanted);
    show_slice({});
}

QWidget* SliceEditor::make_tool_row() {
    auto* bar = new QToolBar(this);  // what finds no room goes into a menu at its end
    bar->setObjectName("slice_tools");
    bar->setToolButtonStyle(Qt::ToolButtonTextOnly);
    for (const char* name : {"select", "draw", "add_path", "add_dot", "", "duplicate", "remove", "enable", "",
                             "earlier", "later", "", "insert_position", "turn", "", "fit"}) {
        if (*name == 0) {
            bar->addSeparator();
            continue;
        }
        bar->addAction(m_canvas->action(name));
        bar->widgetForAction(m_canvas->action(name))->setFocusPolicy(Qt::TabFocus);
    }
    if (auto* more = bar->findChild<QToolButton*>("qt_toolbar_ext_button")) {
        more->setIcon({});  // the style's own is black, which dark palettes swallow
        more->setText(tr("»"));
        more->setToolTip(tr("More tools"));
    }
    return bar;
}

QWidget* SliceEditor::make_begin_row() {
    auto* row = new QWidget(this);
    auto* layout = new QHBoxLayout(row);
    auto* positions = new QSpinBox(row);
    positions->setObjectName("begin_positions");
    positions->setRange(1, 1000);
    positions->setValue(5);
    positions->setPrefix(tr("Positions: "));
    auto* button = new QPushButton(tr("Begin the slice"), row);
    button->setObjectName("begin");
    layout->addStretch(1);
    layout->addWidget(positions);
    layout->addWidget(button);
    layout->addStretch(1);
    connect(button, &QPushButton::clicked, this, [this, positions] { begin(positions->value()); });
    return row;
}

void SliceEditor::begin(int positions) {
    const Result<Slice> slice = new_slice(m_canvas->slice().dots, static_cast<std::size_t>(positions));
    if (!slice) {
        Q_EMIT status(QString::fromStdString(slice.error().text()));
        return;
    }
    show_slice(*slice);
    m_canvas->setFocus();
    Q_EMIT edited(*slice, tr("Begin a slice"));
}

void SliceEditor::show_slice(const Slice& slice) {
    m_pages->setCurrentIndex(0);
    setFocusProxy(m_canvas);
    m_begin_row->setVisible(slice.positions.empty());
    m_tool_row->setDisabled(slice.positions.empty());
    if (slice == m_canvas->slice() && !slice.positions.empty()) return;
    m_canvas->show_slice(slice);
}

SliceCanvas& SliceEditor::canvas_in_sight() {
    if (m_pages->currentIndex() == 0) return *m_canvas;
    return m_reader->canvas();
}

void SliceEditor::set_design(const Design& design) {
    m_canvas->set_design(design);
}

void SliceEditor::show_block(const Design& design, BlockPtr block, System dots, std::size_t line) {
    m_pages->setCurrentIndex(1);
    setFocusProxy(m_reader);
    m_reader->show_block(design, std::move(block), dots, line);
}

}  // namespace weave::studio
