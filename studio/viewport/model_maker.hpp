#pragma once

#include <studio/viewport/tube_model.hpp>

#include <QObject>
#include <QThreadPool>

#include <atomic>
#include <functional>
#include <memory>

namespace weave::studio {

/// Makes models in a thread of its own, so that the window's never waits for a large cloth. Of several that
/// are asked for one after the other only the last comes.
class ModelMaker : public QObject {
    Q_OBJECT
  public:
    using Make = std::function<Result<TubeModel>()>;
    explicit ModelMaker(QObject* parent = nullptr);
    ~ModelMaker() override;

    /// `make` runs in another thread: what it uses must not change meanwhile.
    void ask(Make make);
    /// What has been asked for will not come.
    void forget();
    [[nodiscard]] bool is_busy() const { return m_is_busy; }

  Q_SIGNALS:
    void made(std::shared_ptr<weave::studio::TubeModel> model);
    void failed(const QString& words);

  private:
    void take(std::uint64_t number, std::shared_ptr<TubeModel> model, const QString& words);
    QThreadPool m_threads;
    std::atomic<std::uint64_t> m_asked{0};
    bool m_is_busy = false;
};

}  // namespace weave::studio
