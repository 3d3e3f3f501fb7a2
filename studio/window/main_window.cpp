#include <studio/window/main_window.hpp>

namespace weave::studio {

MainWindow::MainWindow(QWidget* parent) : QMainWindow(parent) {}

}  // namespace weave::studio
