#pragma once

#include <QDialog>

#include <studio/jobs/server_place.hpp>
#include <vector>

class QLabel;
class QPushButton;
class QTableWidget;

namespace weave::studio {

/// The simulation servers that a person has named; remembered between sessions.
std::vector<ServerWish> remembered_servers();
void remember_servers(const std::vector<ServerWish>& servers);

/// A list of servers to be edited.
class ServersDialog : public QDialog {
    Q_OBJECT
  public:
    explicit ServersDialog(const std::vector<ServerWish>& servers, QWidget* parent = nullptr);

    /// Those that have a place.
    [[nodiscard]] std::vector<ServerWish> servers() const;
    [[nodiscard]] QTableWidget* table() const { return m_table; }
    void add(const ServerWish& server);

  private:
    void remove_chosen();
    void choose_token_file();
    void test_chosen();
    [[nodiscard]] ServerWish server_in(int line) const;

    QTableWidget* m_table;
    QLabel* m_answer;  ///< of the server that was tested
    QPushButton* m_test = nullptr;
};

}  // namespace weave::studio
