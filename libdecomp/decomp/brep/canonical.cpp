// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/hash.h"
#include "decomp/brep/canonical_detail.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <vector>

namespace decomp::brep {

namespace {

/// An entity as pieces of text with a reference after each but the last.
struct Entity {
    std::vector<std::string> pieces;
    std::vector<std::uint32_t> references;  ///< indices of entities
    std::string digest;                     ///< of everything below, whatever the numbers
    std::uint32_t number = 0;
};

/// Its members are a set: the kernel lists them in any order.
constexpr std::string_view kStyles = "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION(";

constexpr std::string_view kInstance = "NEXT_ASSEMBLY_USAGE_OCCURRENCE('";

class Rewriter {
  public:
    explicit Rewriter(std::string_view text) : text_(text) {}

    std::string rewrite() {
        const std::size_t data = text_.find("\nDATA;");
        const std::size_t end = text_.rfind("ENDSEC;");
        if (data == std::string_view::npos || end <= data) {
            return std::string(text_);
        }
        const std::size_t body = data + 6;
        read(text_.substr(body, end - body));
        for (std::uint32_t i = 0; i < entities_.size(); ++i) {
            digest(i);
        }
        number_all();
        std::string out(text_.substr(0, body));
        out += '\n';
        std::vector<std::uint32_t> order(entities_.size());
        std::iota(order.begin(), order.end(), 0U);
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return entities_[a].number < entities_[b].number;
        });
        for (const std::uint32_t i : order) {
            append(entities_[i], out);
        }
        out += text_.substr(end);
        return out;
    }

  private:
    /// Statements without line breaks; quoted text is kept as it is.
    void read(std::string_view body) {
        std::vector<std::vector<std::uint64_t>> wanted;
        std::unordered_map<std::uint64_t, std::uint32_t> index;
        std::size_t at = 0;
        while ((at = body.find('#', at)) != std::string_view::npos) {
            Entity entity;
            const std::uint64_t id = number_at(body, at);
            at = body.find('=', at) + 1;
            std::vector<std::uint64_t> references;
            entity.pieces.emplace_back();
            bool quoted = false;
            for (; at < body.size() && (quoted || body[at] != ';'); ++at) {
                const char c = body[at];
                quoted = quoted != (c == '\'');
                if (!quoted && c == '#') {
                    references.push_back(number_at(body, at));
                    entity.pieces.emplace_back();
                    --at;
                } else if (quoted ? c != '\n' : (c != '\n' && c != '\r' && c != ' ')) {
                    entity.pieces.back() += c;
                }
            }
            // The kernel counts instances over all files that a process writes.
            std::string& head = entity.pieces[0];
            if (head.starts_with(kInstance)) {
                const std::size_t end = head.find('\'', kInstance.size());
                head = std::string(kInstance) + std::to_string(++instances_) + head.substr(end);
            }
            index.emplace(id, static_cast<std::uint32_t>(entities_.size()));
            entities_.push_back(std::move(entity));
            wanted.push_back(std::move(references));
        }
        for (std::size_t i = 0; i < entities_.size(); ++i) {
            for (const std::uint64_t id : wanted[i]) {
                entities_[i].references.push_back(index.at(id));
            }
        }
    }

    static std::uint64_t number_at(std::string_view body, std::size_t& at) {
        std::uint64_t id = 0;
        const char* begin = body.data() + at + 1;
        const auto [end, error] = std::from_chars(begin, body.data() + body.size(), id);
        at += 1 + static_cast<std::size_t>(end - begin);
        return id;
    }

    /// From the leaves up, without recursion: chains of references may be long.
    void digest(std::uint32_t root) {
        std::vector<std::uint32_t> open{root};
        while (!open.empty()) {
            Entity& entity = entities_[open.back()];
            if (!entity.digest.empty()) {
                open.pop_back();
                continue;
            }
            bool ready = true;
            for (const std::uint32_t r : entity.references) {
                if (entities_[r].digest.empty()) {
                    open.push_back(r);
                    ready = false;
                }
            }
            if (!ready) {
                continue;
            }
            if (entity.pieces[0].starts_with(kStyles)) {
                // The last reference is the context.
                std::stable_sort(entity.references.begin(), entity.references.end() - 1,
                                 [&](std::uint32_t a, std::uint32_t b) {
                                     return entities_[a].digest < entities_[b].digest;
                                 });
            }
            std::string contents = entity.pieces[0];
            for (std::size_t i = 0; i < entity.references.size(); ++i) {
                contents += '#' + entities_[entity.references[i]].digest + entity.pieces[i + 1];
            }
            entity.digest = sha256_hex(contents).substr(0, 32);
            open.pop_back();
        }
    }

    void number_all() {
        std::vector<bool> referred(entities_.size(), false);
        for (const Entity& entity : entities_) {
            for (const std::uint32_t r : entity.references) {
                referred[r] = true;
            }
        }
        // The kernel lists roots in the order of the bodies, all but the styles.
        std::vector<std::uint32_t> roots;
        for (std::uint32_t i = 0; i < entities_.size(); ++i) {
            if (!referred[i]) {
                roots.push_back(i);
            }
        }
        const auto styles = std::stable_partition(roots.begin(), roots.end(), [&](std::uint32_t i) {
            return !entities_[i].pieces[0].starts_with(kStyles);
        });
        std::stable_sort(styles, roots.end(), [&](std::uint32_t a, std::uint32_t b) {
            return entities_[a].digest < entities_[b].digest;
        });
        std::uint32_t next = 0;
        std::vector<std::uint32_t> open(roots.rbegin(), roots.rend());
        while (!open.empty()) {
            Entity& entity = entities_[open.back()];
            open.pop_back();
            if (entity.number != 0) {
                continue;
            }
            entity.number = ++next;
            open.insert(open.end(), entity.references.rbegin(), entity.references.rend());
        }
    }

    void append(const Entity& entity, std::string& out) const {
        out += '#' + std::to_string(entity.number) + '=' + entity.pieces[0];
        for (std::size_t i = 0; i < entity.references.size(); ++i) {
            out +=
                '#' + std::to_string(entities_[entity.references[i]].number) + entity.pieces[i + 1];
        }
        out += ";\n";
    }

    std::string_view text_;
    std::vector<Entity> entities_;
    int instances_ = 0;
};

}  // namespace

std::string canonical_step(std::string_view text) { return Rewriter(text).rewrite(); }

}  // namespace decomp::brep
