#pragma once

#include <QCoreApplication>
#include <QObject>
#include <QPointer>
#include <QThreadPool>

#include <utility>

namespace weave::studio {

/// Does `work` in another thread and hands what it gives to `done` in the window's, unless `receiver` is gone by then.
template <class Work, class Done>
void in_background(QObject* receiver, Work work, Done done) {
    QThreadPool::globalInstance()->start([receiver = QPointer<QObject>(receiver), work = std::move(work), done = std::move(done)]() mutable {
        auto made = work();
        QMetaObject::invokeMethod(QCoreApplication::instance(), [receiver, done = std::move(done), made = std::move(made)]() mutable {
            if (receiver) done(std::move(made));
        });
    });
}

}  // namespace weave::studio
