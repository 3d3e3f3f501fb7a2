#include <studio/editors/slice_reader.hpp>

#include <studio/jobs/background.hpp>

#include <QHBoxLayout>
#include <QSignalBlocker>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>
#include <utility>

namespace weave::studio {

namespace {

/// Blocks of so many crossings are read at once, within a frame.
constexpr std::size_t most_at_once = 40000;

QString range(const QString& one, const QString& many, std::size_t first, std::size_t after) {
    return after - first == 1 ? one.arg(first + 1) : many.arg(first + 1).arg(after);
}

}  // namespace

SliceReader::SliceReader(QWidget* parent)
    : QWidget(parent),
      m_canvas(new SliceReadCanvas(this)),
      m_direction(new QComboBox(this)),
      m_kind(new QLabel(this)),
      m_count(new QLabel(this)),
      m_yarns(new QLabel(this)),
      m_number(new QSpinBox(this)),
      m_slider(new QSlider(Qt::Horizontal, this)),
      m_along(new QScrollBar(Qt::Horizontal, this)) {
    m_direction->addItems({tr("Along the warp"), tr("Along the weft")});
    m_direction->setToolTip(
        tr("Along the warp wefts are dots and one column of ends runs through; along the weft the reverse"));
    m_direction->setObjectName("direction");
    m_number->setObjectName("line");
    m_number->setKeyboardTracking(false);
    m_slider->setObjectName("line_slider");
    m_along->setObjectName("along");
    m_along->setToolTip(tr("Which part of the slice is shown"));
    auto* fit = new QToolButton(this);
    fit->setText(tr("Fit"));
    fit->setToolTip(tr("Show the slice from its begin (F)"));
    auto* row = new QHBoxLayout;
    for (QWidget* widget : std::initializer_list<QWidget*>{m_direction, m_kind, m_number, m_count})
        row->addWidget(widget);
    row->addWidget(m_yarns);
    row->addStretch(1);
    row->addWidget(fit);
    auto* rows = new QVBoxLayout(this);
    rows->setContentsMargins(0, 0, 0, 0);
    rows->addLayout(row);
    rows->addWidget(m_slider);  // a row of its own, so that it is long where the editor is narrow
    rows->addWidget(m_canvas, 1);
    rows->addWidget(m_along);
    connect(fit, &QToolButton::clicked, m_canvas, &SliceCanvas::fit);
    connect(m_number, &QSpinBox::valueChanged, this, [this](int number) { set_line(number - 1); });
    connect(m_slider, &QSlider::valueChanged, this, [this](int number) { set_line(number - 1); });
    connect(m_direction, &QComboBox::activated, this,
            [this](int index) { set_direction(index == 0 ? System::weft : System::warp); });
    connect(m_along, &QScrollBar::valueChanged, this,
            [this](int value) { m_canvas->go_to(static_cast<std::size_t>(value)); });
    connect(m_canvas, &SliceCanvas::moved, this, &SliceReader::follow_canvas);
    connect(m_canvas, &SliceCanvas::status, this, &SliceReader::status);
    connect(m_canvas, &SliceReadCanvas::flip_wanted, this, &SliceReader::flip_wanted);
    setFocusProxy(m_canvas);
}

void SliceReader::show_block(const Design& design, BlockPtr block, System dots, std::size_t line) {
    m_dots = dots;
    m_line = line;
    const std::size_t reading = ++m_reading;
    const BlockSlices* shown = m_canvas->slices();
    const auto looks_alike = [&](const Design& other) {
        return other.warp == design.warp && other.weft == design.weft && other.scene == design.scene;
    };
    if (shown != nullptr && &shown->block() == block.get() && looks_alike(shown->design())) return show_line();
    const auto read = [design, block] { return std::make_shared<const BlockSlices>(design, block); };
    if (block->picks() * block->ends() <= most_at_once) return take(read(), reading);
    // After an edit the slice stays until the new one is there; a block with other counts is another one.
    if (shown != nullptr && (shown->block().t() != block->t() || shown->block().p() != block->p()))
        m_canvas->show_slices(nullptr, dots, line);
    in_background(this, read, [this, reading](std::shared_ptr<const BlockSlices> slices) {
        take(std::move(slices), reading);
    });
}

void SliceReader::take(std::shared_ptr<const BlockSlices> slices, std::size_t reading) {
    if (reading != m_reading) return;
    m_line = std::min(m_line, slices->lines(m_dots) - 1);
    m_canvas->show_slices(std::move(slices), m_dots, m_line);
    show_line();
}

void SliceReader::show_line() {
    m_line = std::min(m_line, m_canvas->slices()->lines(m_dots) - 1);
    m_canvas->set_line(m_dots, m_line);
    if (const auto place = std::exchange(m_wanted, {})) m_canvas->show_crossing(place->first, place->second);
    name_line();
    follow_canvas();
}

void SliceReader::go_to(std::size_t pick, std::size_t end) {
    m_wanted = {pick, end};
}

void SliceReader::set_direction(System dots) {
    if (m_canvas->slices() == nullptr || dots == m_dots) return;
    m_dots = dots;
    show_line();
}

void SliceReader::set_line(int line) {
    if (m_canvas->slices() == nullptr || line < 0) return;
    m_line = static_cast<std::size_t>(line);
    show_line();
}

void SliceReader::name_line() {
    const BlockSlices& slices = *m_canvas->slices();
    const Block& block = slices.block();
    const bool columns = m_dots == System::weft;
    const int lines = static_cast<int>(slices.lines(m_dots));
    const QSignalBlocker one(m_number), two(m_slider), three(m_direction);
    m_direction->setCurrentIndex(columns ? 0 : 1);
    m_kind->setText(columns ? tr("column") : tr("row"));
    m_count->setText(tr("of %1").arg(lines));
    m_number->setRange(1, lines);
    m_slider->setRange(1, lines);
    m_number->setValue(static_cast<int>(m_line) + 1);
    m_slider->setValue(static_cast<int>(m_line) + 1);
    m_slider->setVisible(lines > 1);
    m_yarns->setText(
        columns ? range(tr("end %1"), tr("ends %1–%2"), block.first_end(m_line), block.first_end(m_line + 1))
                : range(tr("pick %1"), tr("picks %1–%2"), block.first_pick(m_line),
                        block.first_pick(m_line + 1)));
}

/// The scroll bar says where along the slice one is.
void SliceReader::follow_canvas() {
    const QSignalBlocker quiet(m_along);
    const auto [from, count] = m_canvas->seen();
    const std::size_t all = m_canvas->scene().all_positions;
    m_along->setVisible(count < all);
    m_along->setPageStep(static_cast<int>(count));
    m_along->setRange(0, static_cast<int>(all - std::min(all, count)));
    m_along->setValue(static_cast<int>(from));
}

}  // namespace weave::studio
