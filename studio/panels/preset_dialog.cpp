#include <studio/panels/preset_dialog.hpp>

#include <QCheckBox>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPainter>
#include <QPushButton>
#include <QSpinBox>

#include <algorithm>
#include <limits>

namespace weave::studio {

namespace {

constexpr int picture_side = 288;

/// Two repeats of a small card, one of a large one.
QPixmap picture_of(const CardImage& card) {
    const auto picks = static_cast<int>(std::min<std::size_t>(card.picks(), 144)), ends = static_cast<int>(std::min<std::size_t>(card.ends(), 144));
    const int times = std::max(picks, ends) <= 24 ? 2 : 1;
    const int cell = std::max(1, picture_side / (std::max(picks, ends) * times));
    QPixmap pixmap(ends * times * cell + 1, picks * times * cell + 1);
    pixmap.fill(Qt::white);
    QPainter painter(&pixmap);
    for (int row = 0; row < picks * times; ++row) {
        for (int column = 0; column < ends * times; ++column) {
            const QRect box(column * cell, (picks * times - 1 - row) * cell, cell, cell);
            if (!card.weft_over(static_cast<std::size_t>(row % picks), static_cast<std::size_t>(column % ends))) painter.fillRect(box, Qt::black);
            if (cell >= 5) {
                painter.setPen(QColor(128, 128, 128, 120));
                painter.drawRect(box);
            }
        }
    }
    return pixmap;
}

int as_int(std::int64_t value) {
    return static_cast<int>(std::clamp<std::int64_t>(value, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
}

/// `pointed-twill` as a weaver writes it: Pointed twill.
QString plain_name(const std::string& name) {
    QString plain = QString::fromStdString(name).replace('-', ' ');
    if (!plain.isEmpty()) plain[0] = plain[0].toUpper();
    return plain;
}

/// The move takes more words than a rule has room for.
QString help_of(const PresetOption& option) {
    const QString help = QString::fromStdString(option.help);
    if (option.name != "move") return help;
    return PresetDialog::tr("The move (counter): how many yarns further the binding point of the next pick lies. It has no divisor in common with the size. %1").arg(help);
}

}  // namespace

PresetDialog::PresetDialog(QWidget* parent)
    : QDialog(parent), m_families(new QComboBox), m_help(new QLabel), m_form(new QFormLayout), m_picture(new QLabel), m_verdict(new QLabel),
      m_buttons(new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel)) {
    setWindowTitle(tr("Traditional weave"));
    for (const PresetFamily& family : preset_families()) m_families->addItem(plain_name(family.name), QString::fromStdString(family.name));
    m_families->setAccessibleName(tr("Weave"));
    m_help->setWordWrap(true);
    m_verdict->setWordWrap(true);
    m_picture->setFixedSize(picture_side + 12, picture_side + 12);
    m_picture->setAlignment(Qt::AlignCenter);
    m_picture->setAccessibleName(tr("Card of the weave"));
    auto* left = new QVBoxLayout;
    left->addWidget(m_families);
    left->addWidget(m_help);
    left->addLayout(m_form);
    left->addStretch();
    left->addWidget(m_verdict);
    auto* top = new QHBoxLayout;
    top->addLayout(left, 1);
    top->addWidget(m_picture);
    auto* all = new QVBoxLayout(this);
    all->addLayout(top);
    all->addWidget(m_buttons);
    connect(m_families, &QComboBox::currentIndexChanged, this, &PresetDialog::show_options);
    connect(m_buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
    connect(m_buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    show_options();
    resize(640, sizeHint().height());
}

void PresetDialog::show_options() {
    while (m_form->rowCount() > 0) m_form->removeRow(0);
    m_numbers.clear();
    m_choices.clear();
    m_help->setText(QString::fromStdString(family().help));
    for (const PresetOption& option : family().options) {
        QWidget* field = make_field(option);
        field->setObjectName(QString::fromStdString(option.name));
        field->setAccessibleName(plain_name(option.name));
        field->setToolTip(help_of(option));
        if (m_choices.contains(option.name)) {
            m_form->addRow(field);
            continue;
        }
        auto* label = new QLabel(plain_name(option.name));
        label->setToolTip(field->toolTip());
        label->setBuddy(field);
        m_form->addRow(label, field);
    }
    try_out();
}

/// What can only be 0 or 1 is a box to tick.
QWidget* PresetDialog::make_field(const PresetOption& option) {
    if (option.low == 0 && option.high == 1) {
        auto* box = new QCheckBox(plain_name(option.name));
        box->setChecked(option.fallback != 0);
        connect(box, &QCheckBox::toggled, this, &PresetDialog::try_out);
        return m_choices[option.name] = box;
    }
    auto* box = new QSpinBox;
    box->setRange(as_int(option.low), as_int(option.high));
    box->setValue(as_int(option.fallback));
    if (option.name == "move" && option.low == 0) box->setSpecialValueText(tr("the most even"));
    connect(box, &QSpinBox::valueChanged, this, &PresetDialog::try_out);
    return m_numbers[option.name] = box;
}

const PresetFamily& PresetDialog::family() const {
    return preset_families()[static_cast<std::size_t>(m_families->currentIndex())];
}

std::int64_t PresetDialog::value_of(const PresetOption& option) const {
    if (const auto choice = m_choices.find(option.name); choice != m_choices.end()) return choice->second->isChecked() ? 1 : 0;
    const auto number = m_numbers.find(option.name);
    return number == m_numbers.end() ? option.fallback : number->second->value();
}

void PresetDialog::try_out() {
    const auto block = make_preset(preset());
    m_buttons->button(QDialogButtonBox::Ok)->setEnabled(static_cast<bool>(block));
    if (!block) {
        m_verdict->setText(QString::fromStdString(block.error().text()));
        m_picture->setText(tr("no such weave"));
        return;
    }
    m_verdict->setText(tr("%1 × %2 in a repeat").arg(tr("%n pick(s)", nullptr, static_cast<int>(block->picks())), tr("%n end(s)", nullptr, static_cast<int>(block->ends()))));
    m_picture->setPixmap(picture_of(block->card_image()));
}

void PresetDialog::set_preset(const Preset& preset) {
    m_families->setCurrentIndex(std::max(0, m_families->findData(QString::fromStdString(preset.family))));
    for (const auto& [name, value] : preset.options) {
        if (m_numbers.contains(name)) m_numbers.at(name)->setValue(as_int(value));
        if (m_choices.contains(name)) m_choices.at(name)->setChecked(value != 0);
    }
}

Preset PresetDialog::preset() const {
    Preset preset{family().name, {}};
    for (const PresetOption& option : family().options) {
        if (value_of(option) != option.fallback) preset.options[option.name] = value_of(option);
    }
    return preset;
}

}  // namespace weave::studio
