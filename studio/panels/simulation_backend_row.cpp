#include <studio/panels/simulation_backend_row.hpp>

#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QSettings>
#include <QSignalBlocker>
#include <QToolButton>

#include <algorithm>
#include <studio/panels/simulation_servers.hpp>

namespace weave::studio {

namespace {

const char* const remembered_place = "simulation/place";

}  // namespace

BackendRow::BackendRow(QWidget* parent)
    : QWidget(parent), m_choice(new QComboBox(this)), m_edit(new QToolButton(this)) {
    auto* label = new QLabel(tr("C&omputed on"), this);
    label->setBuddy(m_choice);
    auto* line = new QHBoxLayout(this);
    line->setContentsMargins(0, 0, 0, 0);
    line->addWidget(label);
    line->addWidget(m_choice, 1);
    line->addWidget(m_edit);
    m_choice->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    m_choice->setAccessibleName(tr("Computed on"));
    m_choice->setToolTip(
        tr("This computer, or a simulation server (simd). Takes effect when the simulation starts again."));
    m_edit->setText(tr("Servers …"));
    m_edit->setToolTip(tr("Name simulation servers"));
    set_servers(remembered_servers());
    const int remembered = m_choice->findText(QSettings().value(remembered_place).toString());
    m_choice->setCurrentIndex(std::max(0, remembered));
    connect(m_choice, &QComboBox::currentIndexChanged, this, [this] {
        remember();
        Q_EMIT edited();
    });
    connect(m_edit, &QToolButton::clicked, this, &BackendRow::edit_servers);
}

void BackendRow::set_servers(const std::vector<ServerWish>& servers) {
    const QString chosen = m_choice->currentText();
    m_servers = servers;
    const QSignalBlocker quiet(m_choice);
    m_choice->clear();
    m_choice->addItem(tr("This computer"));
    for (const ServerWish& server : m_servers) m_choice->addItem(QString::fromStdString(server.host));
    m_choice->setCurrentIndex(std::max(0, m_choice->findText(chosen)));
}

std::optional<ServerWish> BackendRow::server() const {
    const int index = m_choice->currentIndex();
    if (index <= 0) return {};
    return m_servers.at(static_cast<std::size_t>(index - 1));
}

void BackendRow::remember() const {
    QSettings().setValue(remembered_place,
                         m_choice->currentIndex() > 0 ? m_choice->currentText() : QString());
}

void BackendRow::edit_servers() {
    auto* dialog = new ServersDialog(m_servers, this);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    connect(dialog, &QDialog::accepted, this, [this, dialog] {
        set_servers(dialog->servers());
        remember_servers(m_servers);
        remember();
        Q_EMIT edited();
    });
    dialog->open();
}

}  // namespace weave::studio
