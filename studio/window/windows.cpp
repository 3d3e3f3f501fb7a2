#include <studio/window/windows.hpp>

#include <algorithm>
#include <studio/jobs/background.hpp>
#include <utility>

namespace weave::studio {

void Windows::open(const QStringList& paths) {
    m_has_start_page = paths.isEmpty();
    if (paths.isEmpty()) add();
    for (const QString& path : paths) open_in_new(path);
}

void Windows::open_in_new(const QString& path) {
    MainWindow& window = add();
    connect(&window, &MainWindow::not_opened, this, [this, &window](const QString& reason) { gather(window, reason); }, Qt::SingleShotConnection);
    window.open_file(path);
}

/// Four files that cannot be opened are no reason for four start pages.
void Windows::gather(MainWindow& empty, const QString& reason) {
    if (empty.document() != nullptr) return;  // the person has begun something else in it
    m_reasons.push_back(reason);
    if (m_failed == nullptr) m_failed = &empty;
    if (m_failed == &empty) return;
    m_failed->warn(m_reasons.join('\n'));
    const auto found = std::ranges::find(m_windows, &empty, [](const auto& window) { return window.get(); });
    MainWindow* spare = found->release();
    m_windows.erase(found);
    spare->close();
    spare->deleteLater();  // it is telling of its file just now
}

void Windows::recover(const std::filesystem::path& recoveries) {
    m_windows.front()->tell(tr("Looking for unsaved work …"));
    in_background(
        this, [recoveries, home = thread()] { return left_in(recoveries, home); }, [this](LeftWork left) { show(std::move(left)); });
}

/// The documents live in the thread `home`.
Windows::LeftWork Windows::left_in(const std::filesystem::path& recoveries, QThread* home) {
    Recoveries taken = Keeper::take_recoveries(recoveries);
    LeftWork left{{}, taken.set_aside};
    for (Recovery& recovery : taken.found) {
        left.documents.push_back(std::make_unique<Document>(std::move(recovery)));
        left.documents.back()->moveToThread(home);
    }
    return left;
}

void Windows::show(LeftWork left) {
    m_windows.front()->tell({});
    for (auto& document : left.documents) free_one().recover(std::move(document));
    if (!left.set_aside.isEmpty()) m_windows.back()->tell_set_aside(left.set_aside);
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
