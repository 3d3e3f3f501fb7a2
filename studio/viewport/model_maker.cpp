#include <studio/viewport/model_maker.hpp>

#include <new>

namespace weave::studio {

ModelMaker::ModelMaker(QObject* parent) : QObject(parent) {
    m_threads.setMaxThreadCount(1);
}

ModelMaker::~ModelMaker() {
    forget();
    m_threads.clear();
    m_threads.waitForDone();
}

void ModelMaker::ask(Make make) {
    const std::uint64_t number = ++m_asked;
    m_is_busy = true;
    m_threads.start([this, number, make = std::move(make)] {
        if (number != m_asked) return;  // something newer was asked for
        std::shared_ptr<TubeModel> model;
        QString words;
        try {
            auto result = make();
            if (result) {
                model = std::make_shared<TubeModel>(std::move(result).value());
            } else {
                words = QString::fromStdString(result.error().text());
            }
        } catch (const std::bad_alloc&) {
            words = tr("there is not enough memory to show this cloth");
        }
        QMetaObject::invokeMethod(
            this, [this, number, model, words] { take(number, model, words); }, Qt::QueuedConnection);
    });
}

void ModelMaker::forget() {
    ++m_asked;
    m_is_busy = false;
}

void ModelMaker::take(std::uint64_t number, std::shared_ptr<TubeModel> model, const QString& words) {
    if (number != m_asked) return;
    m_is_busy = false;
    if (model != nullptr) {
        Q_EMIT made(std::move(model));
    } else {
        Q_EMIT failed(words);
    }
}

}  // namespace weave::studio
