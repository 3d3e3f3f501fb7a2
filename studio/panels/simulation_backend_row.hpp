#pragma once

#include <QWidget>

#include <optional>
#include <studio/jobs/server_place.hpp>
#include <vector>

class QComboBox;
class QToolButton;

namespace weave::studio {

/// Where a simulation is computed: on this computer, or on one of the servers that the person has named.
/// Remembered.
class BackendRow : public QWidget {
    Q_OBJECT
  public:
    explicit BackendRow(QWidget* parent = nullptr);

    /// Nothing: this computer.
    [[nodiscard]] std::optional<ServerWish> server() const;
    void set_servers(const std::vector<ServerWish>& servers);
    [[nodiscard]] QComboBox* choice() const { return m_choice; }

  Q_SIGNALS:
    void edited();

  private:
    void edit_servers();
    void remember() const;

    QComboBox* m_choice;
    QToolButton* m_edit;
    std::vector<ServerWish> m_servers;
};

}  // namespace weave::studio
