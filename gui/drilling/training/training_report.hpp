// A training session on paper: JSON, a page of HTML with pictures, and a row of a table over all sessions.
//
// Page     one file that needs nothing else; pictures are inside
// Table    CSV with a head; rows are appended whole, so sessions that end at once do not mix
// Text     names of people, tasks and structures may hold anything: escaped in HTML, quoted in CSV
// Fails by StartupError: a folder or a file that cannot be written
// Thread   any
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gui/drilling/training/training_score.hpp"
#include "ipc/scene/bone/bone_labels.hpp"

namespace tact {

struct TrainingPicture {
    std::string name;
    std::vector<std::uint8_t> png;
};

struct TrainingSession {
    std::string trainee, scene, date;  // date: 2026-11-27 23:05
    const TrainingPlan* plan = nullptr;
    TrainingScore score;
    nlohmann::json performance;                  // drill_report()
    std::vector<TrainingPicture> before, after;  // the same views
};

[[nodiscard]] nlohmann::json training_json(const TrainingSession& session);
// earlier: rows of the same trainee and task, as read_training_table() gives them.
[[nodiscard]] std::string training_page(const TrainingSession& session,
                                        const std::vector<std::vector<std::string>>& earlier);
void append_training_row(const std::filesystem::path& table, const TrainingSession& session);
// Rows of a trainee and a task: date, total, time and so on, as in kTrainingColumns. None where there is no table.
[[nodiscard]] std::vector<std::vector<std::string>> read_training_table(const std::filesystem::path& table,
                                                                        const std::string& trainee,
                                                                        const std::string& title);
// Writes report.html and report.json in a new folder and appends to training.csv beside it. Returns the page's path.
std::filesystem::path write_training(const std::filesystem::path& folder, const TrainingSession& session);

}  // namespace tact
