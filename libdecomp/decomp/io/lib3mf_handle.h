// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>

namespace decomp::io {

/// Owns one object of lib3mf's C interface, which calls all of them void**; Release is its release
/// function.
template <auto Release>
class Lib3mfHandle {
  public:
    Lib3mfHandle() = default;

    explicit Lib3mfHandle(void** object) : object_(object) {}

    Lib3mfHandle(Lib3mfHandle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}

    Lib3mfHandle& operator=(Lib3mfHandle&& other) noexcept {
        std::swap(object_, other.object_);
        return *this;
    }

    Lib3mfHandle(const Lib3mfHandle&) = delete;
    Lib3mfHandle& operator=(const Lib3mfHandle&) = delete;

    ~Lib3mfHandle() {
        if (object_ != nullptr) {
            Release(object_);
        }
    }

    [[nodiscard]] void** get() const { return object_; }

    /// Where the C interface puts a new object.
    [[nodiscard]] void*** out() { return &object_; }

  private:
    void** object_ = nullptr;
};

}  // namespace decomp::io
