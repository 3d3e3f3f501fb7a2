#include <studio/window/windows.hpp>

#include <studio/jobs/background.hpp>
#include <utility>

namespace weave::studio {

void Windows::open(const QStringList& paths) {
    m_has_start_page = paths.isEmpty();
    if (paths.isEmpty()) add();
    for (const QString& path : paths) add().open_file(path);
}

void Windows::recover(const std::filesystem::path& recoveries) {
    in_background(
        this, [recoveries] { return Keeper::take_recoveries(recoveries); }, [this](Recoveries taken) { show(std::move(taken)); });
}

void Windows::show(Recoveries recoveries) {
    for (Recovery& recovery : recoveries.found) free_one().recover(std::move(recovery));
    if (!recoveries.set_aside.isEmpty()) m_windows.back()->tell_set_aside(recoveries.set_aside);
}

MainWindow& Windows::add() {
    m_windows.push_back(std::make_unique<MainWindow>());
    m_windows.back()->show();
    return *m_windows.back();
}

/// One in which nothing is open or being opened: the start page, or a new one.
MainWindow& Windows::free_one() {
    if (!std::exchange(m_has_start_page, false) || m_windows.front()->document() != nullptr) return add();
    return *m_windows.front();
}

}  // namespace weave::studio
