// tact_tracker.dbc, the file for other tools, against the driver's tables and the bits of its frames.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "hal/tracker/pose_frames.hpp"

namespace tact::hal_tracker_dbc_test {
namespace {

struct DbcSignal {
    unsigned start = 0, bits = 0;
    bool is_signed = false;
    double scale = 0.0, low = 0.0, high = 0.0;
    std::string unit;
};
struct DbcMessage {
    std::string name;
    unsigned bytes = 0;
    bool fd = false;
    std::map<std::string, DbcSignal> signals;
};
struct Dbc {
    std::map<unsigned, DbcMessage> messages;
    std::map<std::string, std::map<unsigned, std::string>> values;  // "id signal" -> raw -> text
};

std::string unquoted(const std::string& word) {
    EXPECT_TRUE(word.size() >= 2 && word.front() == '"' && word.back() == '"') << word;
    return word.size() >= 2 ? word.substr(1, word.size() - 2) : word;
}

// Parses the lines of this file; punctuation between numbers counts as white space.
Dbc read_dbc(const std::string& path) {
    std::ifstream in(path);
    EXPECT_TRUE(in.good()) << path;
    Dbc dbc;
    unsigned id = 0;
    for (std::string line; std::getline(in, line);) {
        std::string spaced = line;
        for (char& c : spaced)
            if (std::string_view(":|@(),[];").find(c) != std::string_view::npos) c = ' ';
        std::istringstream words(spaced);
        std::string kind, name, more;
        words >> kind;
        if (kind == "BO_") {
            DbcMessage m;
            words >> id >> m.name >> m.bytes >> more;
            EXPECT_TRUE(words && !dbc.messages.contains(id)) << line;
            dbc.messages[id] = m;
        } else if (kind == "SG_") {
            DbcSignal g;
            double offset = 1.0;
            std::string order;
            words >> name >> g.start >> g.bits >> order >> g.scale >> offset >> g.low >> g.high >> g.unit >>
                more;
            EXPECT_TRUE(words && offset == 0.0 && (order == "1+" || order == "1-"))
                << line;  // 1: little endian
            g.is_signed = order == "1-";
            g.unit = unquoted(g.unit);
            EXPECT_TRUE(dbc.messages[id].signals.emplace(name, g).second) << line;
        } else if (kind == "BA_" && line.find("\"VFrameFormat\"") != std::string::npos) {
            unsigned message = 0, format = 0;
            words >> name >> more >> message >> format;
            EXPECT_TRUE(words && format == 14) << line;  // StandardCAN_FD in the attribute's list
            dbc.messages[message].fd = true;
        } else if (kind == "VAL_") {
            unsigned message = 0, raw = 0;
            words >> message >> name;
            while (words >> raw >> more)
                dbc.values[std::to_string(message) + " " + name][raw] = unquoted(more);
        }
    }
    return dbc;
}

const Dbc& file() {
    static const Dbc dbc = read_dbc("hal/tracker/tact_tracker.dbc");
    return dbc;
}

// Bit by bit, according to the format's description.
double physical(const DbcSignal& s, const CanFrame& f) {
    double value = 0.0;
    for (unsigned i = 0; i < s.bits; ++i) {
        const unsigned bit = s.start + i;
        if ((f.data[bit / 8] >> (bit % 8) & 1U) == 0) continue;
        const double weight = std::ldexp(1.0, static_cast<int>(i));
        value += s.is_signed && i + 1 == s.bits ? -weight : weight;
    }
    return value * s.scale;
}

double physical(const CanFrame& f, const char* signal) {
    return physical(file().messages.at(f.id).signals.at(signal), f);
}

TEST(TrackerDbc, has_exactly_the_messages_and_signals_of_the_driver) {
    std::size_t messages = 0;
    for (const CanMessage& message : kTrackerMessages) {
        for (unsigned sensor = 0; sensor < message.copies; ++sensor) {
            ++messages;
            ASSERT_TRUE(file().messages.contains(message.id + sensor)) << message.name << sensor;
            const DbcMessage& found = file().messages.at(message.id + sensor);
            EXPECT_EQ(found.name,
                      message.copies > 1 ? message.name + std::to_string(sensor) : std::string(message.name));
            EXPECT_EQ(found.bytes, message.bytes);
            EXPECT_EQ(found.fd, message.fd);
            ASSERT_EQ(found.signals.size(), message.signals.size());
            for (const CanSignal& s : message.signals) {
                ASSERT_TRUE(found.signals.contains(s.name)) << found.name << "." << s.name;
                const DbcSignal& g = found.signals.at(s.name);
                EXPECT_EQ(g.start, s.start) << found.name << "." << s.name;
                EXPECT_EQ(g.bits, s.bits) << found.name << "." << s.name;
                EXPECT_EQ(g.is_signed, s.is_signed) << found.name << "." << s.name;
                EXPECT_NEAR(g.scale, s.scale, 1e-12 * s.scale) << found.name << "." << s.name;
                EXPECT_EQ(g.unit, s.unit) << found.name << "." << s.name;
            }
        }
    }
    EXPECT_EQ(file().messages.size(), messages);
}

TEST(TrackerDbc, signals_fill_their_message_to_the_last_bit_without_overlap) {
    for (const auto& [id, message] : file().messages) {
        std::vector<int> used(message.bytes * 8U, 0);
        for (const auto& [name, s] : message.signals) {
            ASSERT_LE(s.start + s.bits, used.size()) << message.name << "." << name;
            for (unsigned i = 0; i < s.bits; ++i) ++used[s.start + i];
        }
        for (const int n : used) EXPECT_EQ(n, 1) << message.name;
    }
}

TEST(TrackerDbc, names_the_status_like_the_driver) {
    const std::map<unsigned, std::string> expected{
        {static_cast<unsigned>(TrackerStatus::ok), "ok"},
        {static_cast<unsigned>(TrackerStatus::starting), "starting"},
        {static_cast<unsigned>(TrackerStatus::no_source), "no_source"},
        {static_cast<unsigned>(TrackerStatus::fault), "fault"}};
    EXPECT_EQ(file().values.at("240 Status"), expected);
}

// Values that another tool reads from the driver's frames with this file.
TEST(TrackerDbc, decodes_the_frames_of_the_driver) {
    const Vec3 p_m(-0.4321, 1.2345, 0.00005);
    const Quat q = quat_from_rotation_vector(Vec3(0.3, -1.1, 0.7));

    const CanFrame sync = encode(SyncFrame{0xBEEF, 0xFEDCBA98, TrackerStatus::no_source});
    EXPECT_EQ(physical(sync, "Counter"), 0xBEEF);
    EXPECT_EQ(physical(sync, "Time"), 0xFEDCBA98);
    EXPECT_EQ(physical(sync, "Status"), 2);

    const CanFrame pos = encode(PosFrame{3, 11, kSensorValid | kSensorFar, p_m});
    EXPECT_NEAR(physical(pos, "X"), -432.1, 0.0251);
    EXPECT_NEAR(physical(pos, "Y"), 1234.5, 0.0251);
    EXPECT_NEAR(physical(pos, "Z"), 0.05, 0.0251);
    EXPECT_EQ(physical(pos, "Status"), 5);
    EXPECT_EQ(physical(pos, "Counter"), 11);

    const CanFrame quat = encode(QuatFrame{2, 7, q});
    EXPECT_NEAR(physical(quat, "Qx"), q.x(), 0.501 / 4095);
    EXPECT_NEAR(physical(quat, "Qy"), q.y(), 0.501 / 4095);
    EXPECT_NEAR(physical(quat, "Qz"), q.z(), 0.501 / 4095);
    EXPECT_NEAR(physical(quat, "Qw"), q.w(), 0.501 / 4095);
    EXPECT_EQ(physical(quat, "Counter"), 7);

    const CanFrame pose = encode(PoseFrame{1, 200, kSensorValid, 123456789, {p_m, q}, 0.8, 0.2});
    EXPECT_EQ(physical(pose, "Counter"), 200);
    EXPECT_EQ(physical(pose, "Sensor"), 1);
    EXPECT_EQ(physical(pose, "Status"), 1);
    EXPECT_EQ(physical(pose, "Time"), 123456789);
    EXPECT_NEAR(physical(pose, "Y"), 1234.5, 0.0251);
    EXPECT_NEAR(physical(pose, "Qy"), q.y(), 0.501 / 32768);
    EXPECT_NEAR(physical(pose, "Qw"), q.w(), 0.501 / 32768);
    EXPECT_NEAR(physical(pose, "Quality"), 0.8, 0.501 / 255);
    EXPECT_NEAR(physical(pose, "Distortion"), 0.2, 0.501 / 255);
}

}  // namespace
}  // namespace tact::hal_tracker_dbc_test
