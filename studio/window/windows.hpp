#pragma once

#include <QObject>
#include <QStringList>

#include <filesystem>
#include <memory>
#include <studio/window/main_window.hpp>
#include <vector>

namespace weave::studio {

/// The windows of a program.
class Windows : public QObject {
    Q_OBJECT
  public:
    /// Shows one for each file, or one with the start page; files that cannot be opened are told in one window.
    void open(const QStringList& paths);
    /// Reads in the background what ended programs left there, does it again, and shows the designs.
    void recover(const std::filesystem::path& recoveries);

    [[nodiscard]] const std::vector<std::unique_ptr<MainWindow>>& all() const { return m_windows; }

  private:
    MainWindow& add();
    MainWindow& free_one();
    void open_in_new(const QString& path);
    void gather(MainWindow& empty, const QString& reason);
    struct LeftWork {
        std::vector<std::unique_ptr<Document>> documents;
        QStringList set_aside;
    };
    static LeftWork left_in(const std::filesystem::path& recoveries, QThread* home);
    void show(LeftWork left);

    std::vector<std::unique_ptr<MainWindow>> m_windows;
    MainWindow* m_failed = nullptr;  ///< that tells of the files that cannot be opened
    QStringList m_reasons;           ///< why they cannot
    bool m_has_start_page = false;  ///< in the first window, until there is a design in it
};

}  // namespace weave::studio
