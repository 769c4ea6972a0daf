// main() of a program of several test files. Each file has a link to the program under its own name; called by that
// name, the program runs the tests of that file only (and of headers that they share).
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace {

std::string stem_of(const char* path) { return std::filesystem::path(path).stem().string(); }

// The filter of the command line, less the tests of all other files; empty filter if `file` names none of the files.
std::string filter_of(const std::string& file) {
    std::string others;
    bool here = false;
    const auto& all = *testing::UnitTest::GetInstance();
    for (int i = 0; i < all.total_test_suite_count(); ++i) {
        const auto& suite = *all.GetTestSuite(i);
        for (int j = 0; j < suite.total_test_count(); ++j) {
            const auto& test = *suite.GetTestInfo(j);
            if (stem_of(test.file()) == file) {
                here = true;
            } else {
                others += ':' + std::string(suite.name()) + '.' + test.name();
            }
        }
    }
    if (!here) return {};
    const std::string asked = GTEST_FLAG_GET(filter);
    return others.empty() ? asked : asked + (asked.find('-') == std::string::npos ? "-" : "") + others;
}

}  // namespace

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    const std::string filter = filter_of(stem_of(argv[0]));
    if (!filter.empty()) GTEST_FLAG_SET(filter, filter);
    return RUN_ALL_TESTS();
}
