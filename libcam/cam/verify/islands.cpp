// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/islands.h"

#include <bit>
#include <numeric>
#include <span>

namespace cam::verify {
namespace {

struct Run {
    int row;
    int first;
    int last;
    bool carried;
};

/// The first set bit of a row from `at` on, or the row's width; with `flipped` all ones the first
/// clear one.
int first_bit(std::span<const std::uint64_t> words, int at, std::uint64_t flipped) {
    const int width = static_cast<int>(words.size()) * 64;
    while (at < width) {
        const std::uint64_t word = (words[static_cast<std::size_t>(at) >> 6] ^ flipped) >>
                                   (static_cast<unsigned>(at) & 63U);
        if (word != 0) {
            return at + std::countr_zero(word);
        }
        at = (at | 63) + 1;
    }
    return width;
}

std::vector<Run> runs_of(const Bitmap& deposit, const Bitmap& carried) {
    std::vector<Run> runs;
    const Window& window = deposit.window();
    const int width = window.words * 64;
    for (int row = 0; row < window.rows; ++row) {
        const std::span words(deposit.row_words(row), static_cast<std::size_t>(window.words));
        int at = first_bit(words, 0, 0);
        while (at < width) {
            const int first = at;
            at = first_bit(words, first, ~std::uint64_t{0});
            const int last = at - 1;
            const bool rests =
                carried.count(row + window.bottom, first + window.left, last + window.left) > 0;
            runs.push_back({row, first, last, rests});
            at = first_bit(words, at, 0);
        }
    }
    return runs;
}

std::uint32_t root_of(std::vector<std::uint32_t>& parents, std::uint32_t node) {
    while (parents[node] != node) {
        parents[node] = parents[parents[node]];
        node = parents[node];
    }
    return node;
}

}  // namespace

std::vector<Island> find_islands(const Bitmap& deposit, const Bitmap& part, const Bitmap& carried,
                                 Bitmap& floating) {
    const std::vector<Run> runs = runs_of(deposit, carried);
    std::vector<std::uint32_t> parents(runs.size());
    std::iota(parents.begin(), parents.end(), 0U);
    std::size_t above = 0;  // first run of the row before
    for (std::size_t k = 0; k < runs.size(); ++k) {
        while (above < k &&
               (runs[above].row < runs[k].row - 1 ||
                (runs[above].row == runs[k].row - 1 && runs[above].last + 1 < runs[k].first))) {
            ++above;
        }
        for (std::size_t m = above;
             m < k && runs[m].row == runs[k].row - 1 && runs[m].first <= runs[k].last + 1; ++m) {
            const std::uint32_t a = root_of(parents, static_cast<std::uint32_t>(m));
            const std::uint32_t b = root_of(parents, static_cast<std::uint32_t>(k));
            parents[a < b ? b : a] = a < b ? a : b;
        }
    }
    std::vector<char> carries(runs.size(), 0);
    for (std::size_t k = 0; k < runs.size(); ++k) {
        if (runs[k].carried) {
            carries[root_of(parents, static_cast<std::uint32_t>(k))] = 1;
        }
    }
    std::vector<Island> islands;
    std::vector<std::uint32_t> index(runs.size(), 0);
    const Window& window = deposit.window();
    for (std::size_t k = 0; k < runs.size(); ++k) {
        const std::uint32_t root = root_of(parents, static_cast<std::uint32_t>(k));
        if (carries[root] != 0) {
            continue;
        }
        if (root == k) {
            index[k] = static_cast<std::uint32_t>(islands.size());
            islands.push_back({0, 0, runs[k].first + window.left, runs[k].row + window.bottom});
        }
        islands[index[root]].pixels += static_cast<std::size_t>(runs[k].last - runs[k].first + 1);
        const Run& run = runs[k];
        islands[index[root]].part_pixels += static_cast<std::size_t>(
            part.count(run.row + window.bottom, run.first + window.left, run.last + window.left));
        floating.fill(runs[k].row + window.bottom, runs[k].first + window.left,
                      runs[k].last + window.left);
    }
    return islands;
}

}  // namespace cam::verify
