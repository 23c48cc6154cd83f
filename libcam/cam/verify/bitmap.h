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

/// The points within `radius` of a segment; mm.
struct Capsule {
    double ax = 0;
    double ay = 0;
    double bx = 0;
    double by = 0;
    double radius = 0;
};

/// The rows of a grid that are drawn on.
struct GridRows {
    double pixel_mm = 0.1;
    int lowest = 0;
    int highest = 0;

    GridRows(const Window& window, double pixel)
        : pixel_mm(pixel), lowest(window.bottom), highest(window.bottom + window.rows - 1) {}
};

/// Cuts a capsule row by row.
class CapsuleCutter {
  public:
    struct Span {
        double left = 1;
        double right = -1;
    };

    explicit CapsuleCutter(const Capsule& capsule);

    /// The x of the capsule at this y; left > right when there are none.
    [[nodiscard]] Span at(double y) const;

  private:
    void add_cap(double x, double dy, Span& span) const;
    void add_flank(double dy, Span& span) const;

    Capsule c_;
    double length_ = 0;
    double ux_ = 0;  ///< direction from a to b; zero for a point
    double uy_ = 0;
};

/// Calls body(row, i0, i1) for the pixels whose centres lie in the capsule.
template <class Body>
void for_capsule_rows(const Capsule& capsule, const GridRows& rows, const Body& body) {
    const double inverse = 1 / rows.pixel_mm;
    const double low = capsule.ay < capsule.by ? capsule.ay : capsule.by;
    const double high = capsule.ay < capsule.by ? capsule.by : capsule.ay;
    const int from = static_cast<int>(std::ceil((low - capsule.radius) * inverse - 0.5));
    const int to = static_cast<int>(std::floor((high + capsule.radius) * inverse - 0.5));
    const CapsuleCutter cutter(capsule);
    for (int j = from < rows.lowest ? rows.lowest : from; j <= to && j <= rows.highest; ++j) {
        const CapsuleCutter::Span span = cutter.at((j + 0.5) * rows.pixel_mm);
        if (span.left <= span.right) {
            body(j, static_cast<int>(std::ceil(span.left * inverse - 0.5)),
                 static_cast<int>(std::floor(span.right * inverse - 0.5)));
        }
    }
}

inline CapsuleCutter::CapsuleCutter(const Capsule& capsule) : c_(capsule) {
    constexpr double kShortest = 1e-9;
    const double dx = c_.bx - c_.ax;
    const double dy = c_.by - c_.ay;
    length_ = std::sqrt(dx * dx + dy * dy);
    if (length_ > kShortest) {
        ux_ = dx / length_;
        uy_ = dy / length_;
    }
}

inline void CapsuleCutter::add_cap(double x, double dy, Span& span) const {
    const double rest = c_.radius * c_.radius - dy * dy;
    if (rest < 0) {
        return;
    }
    const double half = std::sqrt(rest);
    const bool empty = span.left > span.right;
    span.left = empty || x - half < span.left ? x - half : span.left;
    span.right = empty || x + half > span.right ? x + half : span.right;
}

/// The rectangle between the caps: 0 <= along <= length and |across| <= radius on this row.
inline void CapsuleCutter::add_flank(double dy, Span& span) const {
    constexpr double kLevel = 1e-12;  // direction along a row or a column
    constexpr double kFar = 1e300;
    double low = -kFar;
    double high = kFar;
    if (std::abs(ux_) > kLevel) {
        const double s = (0 - dy * uy_) / ux_;
        const double t = (length_ - dy * uy_) / ux_;
        low = s < t ? s : t;
        high = s < t ? t : s;
    } else if (dy * uy_ < 0 || dy * uy_ > length_) {
        return;
    }
    if (std::abs(uy_) > kLevel) {
        const double s = (dy * ux_ - c_.radius) / uy_;
        const double t = (dy * ux_ + c_.radius) / uy_;
        low = low > (s < t ? s : t) ? low : (s < t ? s : t);
        high = high < (s < t ? t : s) ? high : (s < t ? t : s);
    } else if (std::abs(dy * ux_) > c_.radius) {
        return;
    }
    if (low > high) {
        return;
    }
    const bool empty = span.left > span.right;
    span.left = empty || c_.ax + low < span.left ? c_.ax + low : span.left;
    span.right = empty || c_.ax + high > span.right ? c_.ax + high : span.right;
}

inline CapsuleCutter::Span CapsuleCutter::at(double y) const {
    Span span;
    add_cap(c_.ax, y - c_.ay, span);
    add_cap(c_.bx, y - c_.by, span);
    if (ux_ != 0 || uy_ != 0) {
        add_flank(y - c_.ay, span);
    }
    return span;
}

}  // namespace cam::verify
