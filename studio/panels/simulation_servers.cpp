#include <studio/panels/simulation_servers.hpp>

#include <QDialogButtonBox>
#include <QFileDialog>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QSettings>
#include <QTableWidget>
#include <QVBoxLayout>

namespace weave::studio {

namespace {

const char* const group = "simulation/servers";

}  // namespace

std::vector<ServerWish> remembered_servers() {
    std::vector<ServerWish> servers;
    QSettings settings;
    const int count = settings.beginReadArray(group);
    for (int k = 0; k < count; ++k) {
        settings.setArrayIndex(k);
        servers.push_back({settings.value("place").toString().toStdString(),
                           settings.value("token_file").toString().toStdString(),
                           settings.value("fingerprint").toString().toStdString()});
    }
    settings.endArray();
    return servers;
}

void remember_servers(const std::vector<ServerWish>& servers) {
    QSettings settings;
    settings.remove(group);
    settings.beginWriteArray(group, static_cast<int>(servers.size()));
    for (std::size_t k = 0; k < servers.size(); ++k) {
        settings.setArrayIndex(static_cast<int>(k));
        settings.setValue("place", QString::fromStdString(servers[k].host));
        settings.setValue("token_file", QString::fromStdString(
                                            servers[k].token_file));  // where it lies; never what it says
        settings.setValue("fingerprint", QString::fromStdString(servers[k].fingerprint));
    }
    settings.endArray();
}

ServersDialog::ServersDialog(const std::vector<ServerWish>& servers, QWidget* parent)
    : QDialog(parent), m_table(new QTableWidget(0, 3, this)) {
    setWindowTitle(tr("Simulation servers"));
    m_table->setHorizontalHeaderLabels({tr("Place"), tr("Token file"), tr("Certificate (SHA-256)")});
    m_table->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
    m_table->verticalHeader()->hide();
    m_table->setSelectionBehavior(QAbstractItemView::SelectRows);
    m_table->setAccessibleName(windowTitle());
    for (const ServerWish& server : servers) add(server);
    auto* words = new QLabel(
        tr("A place is box, box:8444, https://box:8444 or unix:PATH. Without a token file the variables "
           "WEAVE_TOKEN_FILE and WEAVE_TOKEN of the environment count. "
           "The certificate's fingerprint is needed only where no authority signed it; simd serve tells it."),
        this);
    words->setWordWrap(true);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this);
    const auto* add_button = buttons->addButton(tr("&Add"), QDialogButtonBox::ActionRole);
    const auto* remove_button = buttons->addButton(tr("&Remove"), QDialogButtonBox::ActionRole);
    const auto* token_button = buttons->addButton(tr("&Token file …"), QDialogButtonBox::ActionRole);
    connect(add_button, &QPushButton::clicked, this, [this] {
        add({});
        m_table->setCurrentCell(m_table->rowCount() - 1, 0);
        m_table->editItem(m_table->currentItem());
    });
    connect(remove_button, &QPushButton::clicked, this, &ServersDialog::remove_chosen);
    connect(token_button, &QPushButton::clicked, this, &ServersDialog::choose_token_file);
    connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    auto* lines = new QVBoxLayout(this);
    lines->addWidget(words);
    lines->addWidget(m_table, 1);
    lines->addWidget(buttons);
    resize(40 * fontMetrics().height(), 18 * fontMetrics().height());
}

void ServersDialog::add(const ServerWish& server) {
    const int line = m_table->rowCount();
    m_table->insertRow(line);
    int column = 0;
    for (const std::string& text : {server.host, server.token_file, server.fingerprint})
        m_table->setItem(line, column++, new QTableWidgetItem(QString::fromStdString(text)));
}

void ServersDialog::remove_chosen() {
    if (m_table->currentRow() >= 0) m_table->removeRow(m_table->currentRow());
}

void ServersDialog::choose_token_file() {
    if (m_table->currentRow() < 0) return;
    const QString file = QFileDialog::getOpenFileName(this, tr("The file with the token"));
    if (!file.isEmpty()) m_table->item(m_table->currentRow(), 1)->setText(file);
}

std::vector<ServerWish> ServersDialog::servers() const {
    std::vector<ServerWish> list;
    for (int line = 0; line < m_table->rowCount(); ++line) {
        const auto text = [&](int column) {
            return m_table->item(line, column)->text().trimmed().toStdString();
        };
        if (!text(0).empty()) list.push_back({text(0), text(1), text(2)});
    }
    return list;
}

}  // namespace weave::studio
