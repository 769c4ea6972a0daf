#include "gui/render/elements.hpp"

namespace tact {
namespace {

constexpr std::uint32_t kColour[] = {
    0xFF1493, 0xFFFFFF, 0xD9FFFF, 0xCC80FF, 0xC2FF00, 0xFFB5B5, 0x909090, 0x3050F8, 0xFF0D0D, 0x90E050,
    0xB3E3F5, 0xAB5CF2, 0x8AFF00, 0xBFA6A6, 0xF0C8A0, 0xFF8000, 0xFFFF30, 0x1FF01F, 0x80D1E3, 0x8F40D4,
    0x3DFF00, 0xE6E6E6, 0xBFC2C7, 0xA6A6AB, 0x8A99C7, 0x9C7AC7, 0xE06633, 0xF090A0, 0x50D050, 0xC88033,
    0x7D80B0, 0xC28F8F, 0x668F8F, 0xBD80E3, 0xFFA100, 0xA62929, 0x5CB8D1, 0x702EB0, 0x00FF00, 0x94FFFF,
    0x94E0E0, 0x73C2C9, 0x54B5B5, 0x3B9E9E, 0x248F8F, 0x0A7D8C, 0x006985, 0xC0C0C0, 0xFFD98F, 0xA67573,
    0x668080, 0x9E63B5, 0xD47A00, 0x940094, 0x429EB0, 0x57178F, 0x00C900, 0x70D4FF, 0xFFFFC7, 0xD9FFC7,
    0xC7FFC7, 0xA3FFC7, 0x8FFFC7, 0x61FFC7, 0x45FFC7, 0x30FFC7, 0x1FFFC7, 0x00FF9C, 0x00E675, 0x00D452,
    0x00BF38, 0x00AB24, 0x4DC2FF, 0x4DA6FF, 0x2194D6, 0x267DAB, 0x266696, 0x175487, 0xD0D0E0, 0xFFD123,
    0xB8B8D0, 0xA6544D, 0x575961, 0x9E4FB5, 0xAB5C00, 0x754F45, 0x428296, 0x420066, 0x007D00, 0x70ABFA,
    0x00BAFF, 0x00A1FF, 0x008FFF, 0x0080FF, 0x006BFF, 0x545CF2, 0x785CE3};

struct Radius {
    std::uint8_t atomic_number;
    float a;
};
constexpr Radius kVdw[] = {
    {0, 1.70F},  {1, 1.20F},  {2, 1.40F},  {3, 1.82F},  {5, 1.92F},  {6, 1.70F},  {7, 1.55F},  {8, 1.52F},
    {9, 1.47F},  {10, 1.54F}, {11, 2.27F}, {12, 1.73F}, {13, 1.84F}, {14, 2.10F}, {15, 1.80F}, {16, 1.80F},
    {17, 1.75F}, {18, 1.88F}, {19, 2.75F}, {20, 2.31F}, {28, 1.63F}, {29, 1.40F}, {30, 1.39F}, {31, 1.87F},
    {33, 1.85F}, {34, 1.90F}, {35, 1.85F}, {36, 2.02F}, {46, 1.63F}, {47, 1.72F}, {48, 1.58F}, {53, 1.98F},
    {54, 2.16F}, {78, 1.75F}, {79, 1.66F}, {80, 1.55F}, {92, 1.86F}};

}  // namespace

Rgb8 element_colour(std::uint8_t atomic_number) {
    const std::uint32_t c = kColour[atomic_number < std::size(kColour) ? atomic_number : 0];
    return {static_cast<std::uint8_t>(c >> 16U), static_cast<std::uint8_t>(c >> 8U & 255U),
            static_cast<std::uint8_t>(c & 255U)};
}

Rgb8 chain_colour(std::size_t chain) {
    static constexpr std::array<Rgb8, 7> kColours{{{230, 159, 0},
                                                   {86, 180, 233},
                                                   {0, 158, 115},
                                                   {240, 228, 66},
                                                   {0, 114, 178},
                                                   {213, 94, 0},
                                                   {204, 121, 167}}};
    return kColours[chain % kColours.size()];
}

float vdw_radius_a(std::uint8_t atomic_number) {
    for (const Radius& r : kVdw)
        if (r.atomic_number == atomic_number) return r.a;
    return 2.0F;
}

}  // namespace tact
