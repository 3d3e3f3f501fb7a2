#include <studio/panels/simulation_servers.hpp>

#include <QDialogButtonBox>
#include <QFileDialog>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSettings>
#include <QStyledItemDelegate>
#include <QTableWidget>
#include <QVBoxLayout>

#include <studio/jobs/background.hpp>
#include <weave/wire/client.hpp>

namespace weave::studio {

namespace {

const char* const group = "simulation/servers";

/// Shows in an empty place what one looks like.
class PlaceDelegate : public QStyledItemDelegate {
  public:
    using QStyledItemDelegate::QStyledItemDelegate;
    QWidget* createEditor(QWidget* parent, const QStyleOptionViewItem& option, const QModelIndex& index) const override {
        QWidget* editor = QStyledItemDelegate::createEditor(parent, option, index);
        if (auto* line = qobject_cast<QLineEdit*>(editor)) line->setPlaceholderText(example_place());
        return editor;
    }

  protected:
    void initStyleOption(QStyleOptionViewItem* option, const QModelIndex& index) const override {
        QStyledItemDelegate::initStyleOption(option, index);
        if (!option->text.isEmpty()) return;
        option->text = example_place();
        option->features |= QStyleOptionViewItem::HasDisplay;
        option->palette.setColor(QPalette::Text, option->palette.color(QPalette::PlaceholderText));
    }

  private:
    static QString example_place() { return ServersDialog::tr("such as box:8444"); }
};

/// What a server says of itself, or why it says nothing.
QString asked(const ServerWish& server) {
    const auto place = place_of(server);
    if (!place) return QString::fromStdString(place.error().text());
    const auto client = wire::Client::connect(*place, "weave studio");
    if (!client) return QString::fromStdString(client.error().text());
    return ServersDialog::tr("%1 answers: %2").arg(QString::fromStdString(place->name), QString::fromStdString(client->welcome().server));
}

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
    : QDialog(parent), m_table(new QTableWidget(0, 3, this)), m_answer(new QLabel(this)) {
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
    m_test = buttons->addButton(tr("T&est"), QDialogButtonBox::ActionRole);
    m_test->setObjectName("test_server");
    m_test->setToolTip(tr("Asks the chosen server who it is"));
    m_answer->setObjectName("server_answer");
    m_answer->setTextFormat(Qt::PlainText);
    m_answer->setWordWrap(true);
    m_table->setItemDelegateForColumn(0, new PlaceDelegate(m_table));
    connect(m_test, &QPushButton::clicked, this, &ServersDialog::test_chosen);
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
    lines->addWidget(m_answer);
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

void ServersDialog::test_chosen() {
    const int line = m_table->currentRow() >= 0 ? m_table->currentRow() : 0;
    const ServerWish server = line < m_table->rowCount() ? server_in(line) : ServerWish{};
    if (server.host.empty()) return m_answer->setText(tr("Add a server first: its place is enough where it is this machine."));
    m_test->setEnabled(false);
    m_answer->setText(tr("Asking %1 …").arg(QString::fromStdString(server.host)));
    in_background(
        this, [server] { return asked(server); },
        [this](const QString& words) {
            m_answer->setText(words);
            m_test->setEnabled(true);
        });
}

ServerWish ServersDialog::server_in(int line) const {
    const auto text = [&](int column) { return m_table->item(line, column)->text().trimmed().toStdString(); };
    return {text(0), text(1), text(2)};
}

std::vector<ServerWish> ServersDialog::servers() const {
    std::vector<ServerWish> list;
    for (int line = 0; line < m_table->rowCount(); ++line) {
        if (const ServerWish server = server_in(line); !server.host.empty()) list.push_back(server);
    }
    return list;
}

}  // namespace weave::studio
