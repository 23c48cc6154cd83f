// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cam::verify {

/// A rectangle of pixels on the one grid of a proof: pixel (i, j) has its centre at ((i + 1/2) p,
/// (j + 1/2) p) mm. `left` is a multiple of 64, so that words of any two windows line up.
struct Window {
    int left = 0;
    int bottom = 0;
    int words = 0;  ///< of 64 pixels, a row
    int rows = 0;

    /// The smallest window that holds the pixel columns [i0, i1] and rows [j0, j1].
    [[nodiscard]] static Window around(int i0, int j0, int i1, int j1) {
        const int first = i0 >= 0 ? i0 / 64 : -((63 - i0) / 64);
        const int last = i1 >= 0 ? i1 / 64 : -((63 - i1) / 64);
        return {first * 64, j0, last - first + 1, j1 - j0 + 1};
    }
};

/// One bit a pixel.
class Bitmap {
  public:
    Bitmap() = default;

    explicit Bitmap(const Window& window)
        : window_(window),
          bits_(static_cast<std::size_t>(window.words) * static_cast<std::size_t>(window.rows)) {}

    [[nodiscard]] const Window& window() const { return window_; }

    [[nodiscard]] bool empty() const { return bits_.empty(); }

    [[nodiscard]] bool get(int i, int j) const {
        const int column = i - window_.left;
        const int row = j - window_.bottom;
        if (column < 0 || row < 0 || row >= window_.rows || column >= window_.words * 64) {
            return false;
        }
        return (row_words(row)[column >> 6] >> (static_cast<unsigned>(column) & 63U) & 1U) != 0;
    }

    /// Sets pixels i0 … i1 of row j, as far as they lie in the window.
    void fill(int j, int i0, int i1) {
        visit(j, i0, i1, [](std::uint64_t& word, std::uint64_t mask) { word |= mask; });
    }

    /// How many of the pixels i0 … i1 of row j are set.
    [[nodiscard]] int count(int j, int i0, int i1) const {
        int sum = 0;
        const_cast<Bitmap*>(this)->visit(j, i0, i1, [&](std::uint64_t word, std::uint64_t mask) {
            sum += std::popcount(word & mask);
        });
        return sum;
    }

    [[nodiscard]] std::size_t count() const {
        std::size_t sum = 0;
        for (const std::uint64_t word : bits_) {
            sum += static_cast<std::size_t>(std::popcount(word));
        }
        return sum;
    }

    [[nodiscard]] std::uint64_t* row_words(int row) {
        return bits_.data() +
               static_cast<std::size_t>(row) * static_cast<std::size_t>(window_.words);
    }

    [[nodiscard]] const std::uint64_t* row_words(int row) const {
        return bits_.data() +
               static_cast<std::size_t>(row) * static_cast<std::size_t>(window_.words);
    }

    [[nodiscard]] std::vector<std::uint64_t>& words() { return bits_; }

    [[nodiscard]] const std::vector<std::uint64_t>& words() const { return bits_; }

    /// Adds the set pixels of another bitmap, of any window, as far as they lie in this one.
    void unite(const Bitmap& other);

  private:
    template <class Visit>
    void visit(int j, int i0, int i1, const Visit& body) {
        const int row = j - window_.bottom;
        if (row < 0 || row >= window_.rows) {
            return;
        }
        const int first = i0 - window_.left < 0 ? 0 : i0 - window_.left;
        const int last =
            i1 - window_.left >= window_.words * 64 ? window_.words * 64 - 1 : i1 - window_.left;
        if (first > last) {
            return;
        }
        std::uint64_t* words = row_words(row);
        const int first_word = first >> 6;
        const int last_word = last >> 6;
        const std::uint64_t head = ~std::uint64_t{0} << (static_cast<unsigned>(first) & 63U);
        const std::uint64_t tail = ~std::uint64_t{0} >> (63U - (static_cast<unsigned>(last) & 63U));
        if (first_word == last_word) {
            body(words[first_word], head & tail);
            return;
        }
        body(words[first_word], head);
        for (int w = first_word + 1; w < last_word; ++w) {
            body(words[w], ~std::uint64_t{0});
        }
        body(words[last_word], tail);
    }

    Window window_;
    std::vector<std::uint64_t> bits_;
};

/// The pixels within `radius` (in pixels) of a set pixel, by steps of one pixel: a disc up to
/// radius 2, an octagon within 6 % of it beyond. O(words * radius).
[[nodiscard]] Bitmap dilated(Bitmap bitmap, int radius);

/// Calls body(row, i0, i1) for the pixel centres within `radius` of the segment a-b; all in mm,
/// pixels of `pixel` mm. Rows outside [lowest, highest] are left out.
template <class Body>
void for_capsule_rows(double ax, double ay, double bx, double by, double radius, double pixel,
                      int lowest, int highest, const Body& body) {
    const double inverse = 1 / pixel;
    const double ys = ay < by ? ay : by;
    const double yl = ay < by ? by : ay;
    const int from = static_cast<int>(std::ceil((ys - radius) * inverse - 0.5));
    const int to = static_cast<int>(std::floor((yl + radius) * inverse - 0.5));
    double ux = bx - ax;
    double uy = by - ay;
    const double length = std::sqrt(ux * ux + uy * uy);
    constexpr double kShortest = 1e-9;
    constexpr double kLevel = 1e-12;  // direction along a row or a column
    const bool long_enough = length > kShortest;
    if (long_enough) {
        ux /= length;
        uy /= length;
    }
    for (int j = from < lowest ? lowest : from; j <= (to > highest ? highest : to); ++j) {
        const double y = (j + 0.5) * pixel;
        double left = 1e300;
        double right = -1e300;
        const double da = radius * radius - (y - ay) * (y - ay);
        if (da >= 0) {
            const double half = std::sqrt(da);
            left = ax - half;
            right = ax + half;
        }
        const double db = radius * radius - (y - by) * (y - by);
        if (db >= 0) {
            const double half = std::sqrt(db);
            left = bx - half < left ? bx - half : left;
            right = bx + half > right ? bx + half : right;
        }
        if (long_enough) {
            // The rectangle between the caps: 0 <= along <= length and |across| <= radius on this
            // row.
            double low = -1e300;
            double high = 1e300;
            const double dy = y - ay;
            if (std::abs(ux) > kLevel) {
                const double s = (0 - dy * uy) / ux;
                const double t = (length - dy * uy) / ux;
                low = s < t ? s : t;
                high = s < t ? t : s;
            } else if (dy * uy < 0 || dy * uy > length) {
                low = 1e300;
            }
            if (std::abs(uy) > kLevel) {
                const double s = (dy * ux - radius) / uy;
                const double t = (dy * ux + radius) / uy;
                const double l = s < t ? s : t;
                const double h = s < t ? t : s;
                low = l > low ? l : low;
                high = h < high ? h : high;
            } else if (std::abs(dy * ux) > radius) {
                low = 1e300;
            }
            if (low <= high) {
                left = ax + low < left ? ax + low : left;
                right = ax + high > right ? ax + high : right;
            }
        }
        if (left <= right) {
            body(j, static_cast<int>(std::ceil(left * inverse - 0.5)),
                 static_cast<int>(std::floor(right * inverse - 0.5)));
        }
    }
}

}  // namespace cam::verify
