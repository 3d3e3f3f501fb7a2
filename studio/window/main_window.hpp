#pragma once

#include <QMainWindow>

namespace weave::studio {

/// The window of one design.
class MainWindow : public QMainWindow {
    Q_OBJECT
  public:
    explicit MainWindow(QWidget* parent = nullptr);
};

}  // namespace weave::studio
