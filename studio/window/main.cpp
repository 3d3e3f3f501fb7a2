#include <studio/window/main_window.hpp>

#include <QApplication>

int main(int argc, char* argv[]) {
    QApplication application(argc, argv);
    weave::studio::MainWindow window;
    window.show();
    return QApplication::exec();
}
