#include "gui/dashboard/drawn_texts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace tact {
namespace {

// Parts of a letter that do not show: hinting and antialiasing.
float beside_px(float line) { return std::max(1.0F, 0.07F * line); }

struct Letter {
    unsigned codepoint = 0;
    float x0 = 0.0F, y0 = 0.0F, x1 = 0.0F, y1 = 0.0F;
    float top = 0.0F, line = 0.0F;               // of the line of text
    float from = 0.0F, to = 0.0F, space = 0.0F;  // of the pen, before and after it; of a space
    bool cut = false, cut_below = false;
};

struct GlyphAt {
    const ImFont* font = nullptr;
    const ImFontGlyph* glyph = nullptr;
};

class Letters {
public:
    Letters() {
        for (const ImFont* const font : ImGui::GetIO().Fonts->Fonts)
            for (const ImFontGlyph& glyph : font->Glyphs)
                if (glyph.Visible != 0)
                    by_corner_.emplace(std::pair{glyph.U0, glyph.V0}, GlyphAt{font, &glyph});
    }
    // Of the quad of these corners; none: no letter. A quad that ImGui has already cut begins inside of its glyph.
    [[nodiscard]] std::optional<Letter> read(const ImDrawVert& first, const ImDrawVert& last) const {
        const auto exact = by_corner_.find({first.uv.x, first.uv.y});
        const GlyphAt at = exact != by_corner_.end() ? exact->second : containing(first.uv, last.uv);
        if (at.glyph == nullptr || !(last.uv.x > first.uv.x) || !(last.uv.y > first.uv.y))
            return std::nullopt;
        const ImFontGlyph& g = *at.glyph;
        Letter letter{g.Codepoint, first.pos.x, first.pos.y, last.pos.x, last.pos.y};
        const float scale =
            (last.pos.y - first.pos.y) / (last.uv.y - first.uv.y) * (g.V1 - g.V0) / (g.Y1 - g.Y0);
        letter.top = first.pos.y - scale * (g.Y0 + (first.uv.y - g.V0) / (g.V1 - g.V0) * (g.Y1 - g.Y0));
        letter.line = scale * at.font->FontSize;
        letter.from = first.pos.x - scale * (g.X0 + (first.uv.x - g.U0) / (g.U1 - g.U0) * (g.X1 - g.X0));
        letter.to = letter.from + scale * g.AdvanceX;
        letter.space = scale * at.font->GetCharAdvance(' ');
        // What a letter reaches beyond its pen, as the hook of a j, may be missing.
        const float beside = beside_px(letter.line);
        letter.cut = first.pos.x - (letter.from + scale * g.X0) > beside ||
                     letter.from + scale * g.X1 - last.pos.x > beside;
        letter.cut_below = first.pos.y - (letter.top + scale * g.Y0) > beside ||
                           letter.top + scale * g.Y1 - last.pos.y > beside;
        return letter;
    }

private:
    [[nodiscard]] GlyphAt containing(const ImVec2& a, const ImVec2& b) const {
        for (const auto& [corner, at] : by_corner_)
            if (at.glyph->U0 <= a.x && b.x <= at.glyph->U1 && at.glyph->V0 <= a.y && b.y <= at.glyph->V1)
                return at;
        return {};
    }
    std::map<std::pair<float, float>, GlyphAt> by_corner_;
};

void add_utf8(std::string& text, unsigned c) {
    if (c < 0x80U) {
        text += static_cast<char>(c);
    } else if (c < 0x800U) {
        text += static_cast<char>(0xC0U | (c >> 6U));
        text += static_cast<char>(0x80U | (c & 0x3FU));
    } else {
        if (c < 0x10000U) {
            text += static_cast<char>(0xE0U | (c >> 12U));
        } else {
            text += static_cast<char>(0xF0U | (c >> 18U));
            text += static_cast<char>(0x80U | ((c >> 12U) & 0x3FU));
        }
        text += static_cast<char>(0x80U | ((c >> 6U) & 0x3FU));
        text += static_cast<char>(0x80U | (c & 0x3FU));
    }
}

// Collects the letters of one draw command.
class Line {
public:
    Line(std::vector<DrawnText>& out, std::string owner, std::size_t list)
        : out_(out), owner_(std::move(owner)), list_(list) {}
    void add(const Letter& l, const ImVec4& clip) {
        const float x0 = std::max(l.x0, clip.x), x1 = std::min(l.x1, clip.z);
        const float y0 = std::max(l.y0, clip.y), y1 = std::min(l.y1, clip.w);
        if (x1 <= x0 || y1 <= y0) return;  // none of it is seen
        const float beside = beside_px(l.line);
        const bool cut = l.cut || l.x0 < clip.x - beside || l.x1 > clip.z + beside;
        const bool cut_below = l.cut_below || l.y0 < clip.y - beside || l.y1 > clip.w + beside;
        const float gap = l.from - end_;
        const bool follows = !now_.text.empty() && std::abs(l.top - top_) < 0.6F && gap > -0.3F * l.line &&
                             gap < 1.8F * l.space;
        if (!follows) finish();
        if (follows && gap > 0.5F * l.space) now_.text += ' ';
        if (now_.text.empty()) now_ = {"", owner_, x0, y0, 0.0F, 0.0F, false, false, list_};
        add_utf8(now_.text, l.codepoint);
        const float right = std::max(now_.x + now_.w, x1), low = std::max(now_.y + now_.h, y1);
        now_.x = std::min(now_.x, x0);
        now_.y = std::min(now_.y, y0);
        now_.w = right - now_.x;
        now_.h = low - now_.y;
        now_.cut = now_.cut || cut;
        now_.cut_below = now_.cut_below || cut_below;
        top_ = l.top;
        end_ = l.to;
    }
    void finish() {
        if (!now_.text.empty()) out_.push_back(std::move(now_));
        now_ = {};
    }

private:
    std::vector<DrawnText>& out_;
    std::string owner_;
    std::size_t list_;
    DrawnText now_;
    float top_ = 0.0F, end_ = 0.0F;
};

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        if (static_cast<unsigned char>(c) >= 0x20U) out += c;
    }
    return out;
}

}  // namespace

std::vector<DrawnText> drawn_texts(const ImDrawData& data) {
    std::vector<DrawnText> out;
    const Letters letters;
    const ImTextureID texture = ImGui::GetIO().Fonts->TexID;
    for (int n = 0; n < data.CmdListsCount; ++n) {
        const ImDrawList& list = *data.CmdLists[n];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            if (command.UserCallback != nullptr || command.TextureId != texture) continue;
            Line line(out, list._OwnerName != nullptr ? list._OwnerName : "", static_cast<std::size_t>(n));
            const ImDrawIdx* const index = list.IdxBuffer.Data + command.IdxOffset;
            const ImDrawVert* const vertex = list.VtxBuffer.Data + command.VtxOffset;
            for (unsigned i = 0; i + 6 <= command.ElemCount;) {
                const ImDrawIdx a = index[i];
                const bool quad = index[i + 1] == a + 1 && index[i + 2] == a + 2 && index[i + 3] == a &&
                                  index[i + 4] == a + 2 && index[i + 5] == a + 3;
                const auto letter = quad ? letters.read(vertex[a], vertex[a + 2]) : std::nullopt;
                if (letter) line.add(*letter, command.ClipRect);
                i += letter ? 6 : 3;
            }
            line.finish();
        }
    }
    return out;
}

std::vector<std::pair<std::size_t, std::size_t>> overlapping(const std::vector<DrawnText>& texts) {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t i = 0; i < texts.size(); ++i)
        for (std::size_t k = i + 1; k < texts.size(); ++k) {
            const DrawnText &a = texts[i], &b = texts[k];
            if (a.list != b.list) continue;
            if (a.text == b.text && std::abs(a.x - b.x) < 1.6F && std::abs(a.y - b.y) < 1.6F) continue;
            const float wide = std::min(a.x + a.w, b.x + b.w) - std::max(a.x, b.x),
                        high = std::min(a.y + a.h, b.y + b.h) - std::max(a.y, b.y);
            if (wide > 1.5F && high > 1.5F) pairs.emplace_back(i, k);
        }
    return pairs;
}

std::string texts_json(const std::vector<DrawnText>& texts) {
    std::string out = "{\"texts\": [";
    char numbers[160];
    for (std::size_t i = 0; i < texts.size(); ++i) {
        const DrawnText& t = texts[i];
        std::snprintf(numbers, sizeof numbers,
                      "\"x\": %.1f, \"y\": %.1f, \"w\": %.1f, \"h\": %.1f, \"cut\": %s, \"cut_below\": %s, "
                      "\"list\": %zu",
                      static_cast<double>(t.x), static_cast<double>(t.y), static_cast<double>(t.w),
                      static_cast<double>(t.h), t.cut ? "true" : "false", t.cut_below ? "true" : "false",
                      t.list);
        out += (i == 0 ? "\n" : ",\n") + std::string("{\"text\": \"") + escaped(t.text) +
               "\", \"owner\": \"" + escaped(t.owner) + "\", " + numbers + "}";
    }
    out += "],\n\"overlaps\": [";
    bool first = true;
    for (const auto& [a, b] : overlapping(texts)) {
        out += std::string(first ? "" : ", ") + "[" + std::to_string(a) + ", " + std::to_string(b) + "]";
        first = false;
    }
    return out + "]}\n";
}

}  // namespace tact
