#pragma once

#include <weave/core/log.hpp>
#include <weave/core/result.hpp>

#include <QCoreApplication>
#include <QObject>
#include <QPointer>
#include <QThreadPool>

#include <exception>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace weave::studio {

/// What work gives; where it throws, as when memory ends, its Error if it can give one, else nothing, which is logged.
template <class Work, class Made = std::invoke_result_t<Work&>>
std::optional<Made> made_by(Work& work) {
    Error fault;
    try {
        return work();
    } catch (const std::bad_alloc&) {
        fault = system_fault("there is not enough memory for this");
    } catch (const std::exception& thrown) {
        fault = system_fault(std::string("this went wrong within the studio: ") + thrown.what());
    }
    if constexpr (std::is_convertible_v<Error, Made>) {
        return Made(std::move(fault));
    } else {
        log(LogLevel::warning, fault.text());
        return std::nullopt;
    }
}

/// Does `work` in another thread and hands what it gives to `done` in the window's, unless `receiver` is gone by then. Work that
/// gives a Result or Status and throws comes to an Error; of other work that throws `done` hears nothing.
template <class Work, class Done>
void in_background(QObject* receiver, Work work, Done done) {
    QThreadPool::globalInstance()->start([receiver = QPointer<QObject>(receiver), work = std::move(work), done = std::move(done)]() mutable {
        auto made = made_by(work);
        if (!made) return;
        QMetaObject::invokeMethod(QCoreApplication::instance(), [receiver, done = std::move(done), made = *std::move(made)]() mutable {
            if (receiver) done(std::move(made));
        });
    });
}

}  // namespace weave::studio
