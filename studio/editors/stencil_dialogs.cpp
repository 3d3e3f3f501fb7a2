#include <studio/editors/stencil_dialogs.hpp>

#include <weave/core/colour.hpp>

#include <QDialogButtonBox>
#include <QFormLayout>
#include <QGridLayout>
#include <QScrollArea>
#include <QScrollBar>
#include <QStandardItemModel>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>

namespace weave::studio {

StencilSizeDialog::StencilSizeDialog(std::size_t rows, std::size_t columns, QWidget* parent)
    : QDialog(parent),
      m_columns(new QSpinBox(this)),
      m_rows(new QSpinBox(this)),
      m_anchor(new QButtonGroup(this)) {
    setObjectName("stencil_size");
    setWindowTitle(tr("Size of the picture"));
    const auto number = [&](QSpinBox* box, const char* name, std::size_t value) {
        box->setObjectName(name);
        box->setRange(1, 20000);
        box->setValue(static_cast<int>(value));
        box->setSuffix(tr(" stacks"));
    };
    number(m_columns, "columns", columns);
    number(m_rows, "rows", rows);
    auto* grid = new QGridLayout;
    grid->setSpacing(1);
    const QString names[] = {tr("top left"),    tr("top"),    tr("top right"),
                             tr("left"),        tr("middle"), tr("right"),
                             tr("bottom left"), tr("bottom"), tr("bottom right")};
    for (int place = 0; place < 9; ++place) {
        auto* button = new QToolButton(this);
        button->setCheckable(true);
        button->setText(place == 4 ? tr("■") : tr("·"));
        button->setToolTip(tr("What is at the %1 stays there").arg(names[place]));
        button->setAccessibleName(names[place]);
        m_anchor->addButton(button, place);
        grid->addWidget(button, place / 3, place % 3);
    }
    const auto mark = [this] {
        for (QAbstractButton* button : m_anchor->buttons())
            button->setText(button->isChecked() ? tr("■") : tr("·"));
    };
    connect(m_anchor, &QButtonGroup::idToggled, this, mark);
    m_anchor->button(6)->setChecked(true);
    mark();
    auto* form = new QFormLayout(this);
    form->addRow(tr("Along the weft (columns)"), m_columns);
    form->addRow(tr("Along the warp (rows)"), m_rows);
    form->addRow(tr("What stays in place"), grid);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this);
    form->addRow(buttons);
    connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
}

PictureMapDialog::PictureMapDialog(const std::vector<CountedColour>& colours,
                                   const std::vector<BlockChoice>& choices, Obstacle obstacle,
                                   QWidget* parent)
    : QDialog(parent), m_obstacle(std::move(obstacle)), m_trouble(new QLabel(this)) {
    setObjectName("picture_map");
    setWindowTitle(tr("Blocks for the picture's colours"));
    for (const BlockChoice& choice : choices) m_names.push_back(choice.name.toStdString());
    auto* table = new QWidget(this);
    auto* grid = new QGridLayout(table);
    const int high = fontMetrics().height() * 3 / 2;
    for (std::size_t k = 0; k < colours.size(); ++k) {
        const Colour colour = colours[k].colour;
        QPixmap swatch(QSize(2 * high, high) * devicePixelRatioF());
        swatch.setDevicePixelRatio(devicePixelRatioF());
        swatch.fill(QColor(colour.red, colour.green, colour.blue));
        auto* patch = new QLabel(table);
        patch->setPixmap(swatch);
        patch->setFrameShape(QFrame::Box);
        auto* box = new QComboBox(table);
        box->setPlaceholderText(tr("Choose a block"));
        box->setAccessibleName(tr("Block for %1").arg(QString::fromStdString(to_text(colour))));
        for (const BlockChoice& choice : choices) {
            box->addItem(choice.thumbnail, choice.reason.isEmpty()
                                               ? choice.name
                                               : tr("%1 — %2").arg(choice.name, choice.reason));
            auto* item = qobject_cast<QStandardItemModel*>(box->model())->item(box->count() - 1);
            item->setEnabled(choice.reason.isEmpty());
        }
        box->setCurrentIndex(-1);
        box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
        box->setMinimumContentsLength(28);
        connect(box, &QComboBox::currentIndexChanged, this, &PictureMapDialog::check);
        m_boxes.push_back(box);
        const int row = static_cast<int>(k);
        grid->addWidget(patch, row, 0);
        grid->addWidget(new QLabel(QString::fromStdString(to_text(colour)), table), row, 1);
        auto* count = new QLabel(tr("%L1 stacks").arg(colours[k].pixels), table);
        count->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
        grid->addWidget(count, row, 2);
        grid->addWidget(box, row, 3);
    }
    grid->setColumnStretch(3, 1);
    grid->setRowStretch(static_cast<int>(colours.size()), 1);
    auto* area = new QScrollArea(this);
    area->setWidget(table);
    area->setWidgetResizable(true);
    area->setFrameShape(QFrame::NoFrame);
    area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    area->setMinimumWidth(table->sizeHint().width() + area->verticalScrollBar()->sizeHint().width());
    m_trouble->setObjectName("trouble");
    m_trouble->setWordWrap(true);
    m_trouble->setTextFormat(Qt::PlainText);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this);
    m_accept = buttons->button(QDialogButtonBox::Ok);
    m_accept->setText(tr("Use the picture"));
    auto* rows = new QVBoxLayout(this);
    rows->addWidget(new QLabel(tr("Each pixel is one stack. Which block does it come from?"), this));
    rows->addWidget(area, 1);
    rows->addWidget(m_trouble);
    rows->addWidget(buttons);
    connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    resize(fontMetrics().averageCharWidth() * 70, fontMetrics().height() * 22);
    check();
}

std::vector<std::string> PictureMapDialog::blocks() const {
    std::vector<std::string> list;
    for (const QComboBox* box : m_boxes) list.push_back(m_names[static_cast<std::size_t>(std::max(0, box->currentIndex()))]);
    return list;
}

void PictureMapDialog::check() {
    std::vector<std::size_t> chosen;
    for (const QComboBox* box : m_boxes) {
        if (box->currentIndex() >= 0) chosen.push_back(static_cast<std::size_t>(box->currentIndex()));
    }
    const QString obstacle = chosen.empty() ? QString() : m_obstacle(chosen);
    const std::size_t open = m_boxes.size() - chosen.size();
    m_trouble->setText(!obstacle.isEmpty() ? obstacle
                       : open > 0          ? tr("%n colour(s) are still without a block", nullptr, static_cast<int>(open))
                                           : QString());
    m_accept->setEnabled(open == 0 && obstacle.isEmpty());
}

}  // namespace weave::studio
