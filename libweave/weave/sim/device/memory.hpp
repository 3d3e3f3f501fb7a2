#pragma once

#include <weave/sim/device/view.hpp>

#include <cstddef>
#include <cstring>
#include <new>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace weave::sim {

/// The memory of a machine that arrays lie in, seen from the processor.
class Memory {
  public:
    virtual ~Memory() = default;
    /// Bytes that hold zeros. Throws std::bad_alloc where there are not so many.
    virtual void* take(std::size_t bytes) = 0;
    virtual void give(void* at) noexcept = 0;
    virtual void put(void* to, const void* from, std::size_t bytes) = 0;
    virtual void get(void* to, const void* from, std::size_t bytes) = 0;
};

/// The processor's own.
class HostMemory : public Memory {
  public:
    void* take(std::size_t bytes) override { return std::memset(::operator new(bytes, std::align_val_t{64}), 0, bytes); }
    void give(void* at) noexcept override { ::operator delete(at, std::align_val_t{64}); }
    void put(void* to, const void* from, std::size_t bytes) override { std::memcpy(to, from, bytes); }
    void get(void* to, const void* from, std::size_t bytes) override { std::memcpy(to, from, bytes); }
};

/// Numbers in the memory of a machine.
template <class T>
class Array {
    static_assert(std::is_trivially_destructible_v<T>); // and copied as bytes, as Eigen's small vectors may be, which do not say so

  public:
    explicit Array(Memory& memory, std::size_t size = 0) : m_memory(&memory) { resize(size); }
    Array(Memory& memory, const std::vector<T>& values) : Array(memory, values.size()) { put(values); }
    Array(Array&& other) noexcept : m_memory(other.m_memory), m_at(std::exchange(other.m_at, nullptr)), m_size(std::exchange(other.m_size, 0)) {}
    Array& operator=(Array&& other) noexcept {
        std::swap(m_memory, other.m_memory);
        std::swap(m_at, other.m_at);
        std::swap(m_size, other.m_size);
        return *this;
    }
    Array(const Array&) = delete;
    Array& operator=(const Array&) = delete;
    ~Array() { clear(); }

    /// So many zeros.
    void resize(std::size_t size) {
        clear();
        if (size > 0) m_at = static_cast<T*>(m_memory->take(size * sizeof(T)));
        m_size = size;
    }
    void put(std::span<const T> values) {
        if (!values.empty()) m_memory->put(m_at, values.data(), values.size_bytes());
    }
    [[nodiscard]] std::vector<T> get() const { return get(m_size); }
    /// The first of them.
    [[nodiscard]] std::vector<T> get(std::size_t count) const {
        std::vector<T> values(count);
        if (count > 0) m_memory->get(values.data(), m_at, count * sizeof(T));
        return values;
    }

    [[nodiscard]] std::size_t size() const { return m_size; }
    [[nodiscard]] std::size_t bytes() const { return m_size * sizeof(T); }
    [[nodiscard]] View<T> view() const { return {m_at, m_size}; }

  private:
    void clear() {
        if (m_at != nullptr) m_memory->give(m_at);
        m_at = nullptr;
        m_size = 0;
    }

    Memory* m_memory;
    T* m_at = nullptr;
    std::size_t m_size = 0;
};

}  // namespace weave::sim
