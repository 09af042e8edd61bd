/// Fields of shapes in the native format: documentation, reader and writer agree for every shape.

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <sstream>

#include "alhazen/formats/native/fields/native_shape_fields.h"
#include "alhazen/formats/native/read/native_shapes.h"
#include "native_round_trip.h"
#include "native_scene.h"
#include "support/random_shapes.h"
#include "support/test_data.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::import_native;

/// One row of the table of shapes in docs/reference/formats/native.md.
struct DocumentedRow {
    std::vector<std::string> keys;  ///< in order, without those of `like`
    std::string like;               ///< another shape that has the other keys too; may be empty
    std::string text;               ///< third column: defaults and explanations
};
using DocumentedShapes = std::map<std::string, std::vector<DocumentedRow>>;

/// The words in backticks.
std::vector<std::string> code_words(const std::string& cell) {
    std::vector<std::string> words;
    for (std::size_t at = cell.find('`'); at != std::string::npos; at = cell.find('`', at + 1)) {
        const std::size_t end = cell.find('`', at + 1);
        words.push_back(cell.substr(at + 1, end - at - 1));
        at = end;
    }
    return words;
}

DocumentedShapes documented_shapes() {
    std::istringstream page(
        read_file(testing::source_folder() / "docs/reference/formats/native.md"));
    DocumentedShapes shapes;
    std::string line, block;
    bool in_table = false;
    while (std::getline(page, line)) {
        if (line.starts_with("## ")) in_table = line == "## Shapes";
        if (!in_table || !line.starts_with("| ")) continue;
        std::istringstream cells(line.substr(1));
        std::string first, second;
        DocumentedRow row;
        std::getline(cells, first, '|');
        std::getline(cells, second, '|');
        std::getline(cells, row.text, '|');
        if (const auto names = code_words(first); !names.empty()) block = names[0];
        row.keys = code_words(second);
        if (second.starts_with(" as ")) {
            row.like = row.keys.at(0);
            row.keys.erase(row.keys.begin());
        }
        shapes[block].push_back(row);
    }
    return shapes;
}

std::set<std::string> documented_keys(const DocumentedShapes& shapes, const std::string& name) {
    std::set<std::string> keys;
    for (const DocumentedRow& row : shapes.at(name)) {
        if (!row.like.empty()) keys.merge(documented_keys(shapes, row.like));
        // "as A, with `b` for `c`": the last replaces a key of A.
        for (const std::string& key : row.keys) {
            if (!keys.insert(key).second) keys.erase(key);
        }
    }
    return keys;
}

/// The keys that the reader lists for an unknown key, in addition to all of `keys`.
std::set<std::string> read_keys(const std::string& shape, const std::set<std::string>& keys) {
    std::string text = shape + " { unheard_of = 1";
    for (const std::string& key : keys)
        text += "; " + key + " = " + (key == "file" ? "\"x\"" : "1");
    const std::string messages = import_native(text + " }").messages();
    const std::string begin = "unknown key 'unheard_of'; known are ";
    const std::size_t at = messages.find(begin);
    EXPECT_NE(at, std::string::npos) << messages;
    std::istringstream list(
        messages.substr(at + begin.size(), messages.find('\n', at) - at - begin.size()));
    std::set<std::string> known;
    for (std::string key; std::getline(list >> std::ws, key, ',');) known.insert(key);
    for (const char* common : {"transform", "motion", "material", "visible_to"}) {
        EXPECT_EQ(known.erase(common), 1u) << shape << ": " << common;
    }
    return known;
}

/// Calls check(S{}) for each type of shape.
template <class Check, class... S>
void for_shape_types(const Check& check, ShapeTypes<S...>) {
    (check(S{}), ...);
}

TEST(NativeFields, TheTableOfShapesListsExactlyTheKeysThatAreRead) {
    const DocumentedShapes shapes = documented_shapes();
    for (const std::string_view name : native_shape_names()) {
        const std::string shape(name);
        ASSERT_TRUE(shapes.contains(shape))
            << shape << " is missing in docs/reference/formats/native.md";
        const std::set<std::string> documented = documented_keys(shapes, shape);
        EXPECT_EQ(read_keys(shape, documented), documented) << shape;
    }
}

TEST(NativeFields, TheTableOfShapesTellsTheDefaults) {
    const DocumentedShapes shapes = documented_shapes();
    for_shape_types(
        [&]<class S>(const S& usual) {
            std::map<std::string, std::string> defaults;
            for_each_field<S>([&](const auto& field) {
                if (field.unit == Unit::Compound || field.unit == Unit::Count) return;
                if constexpr (requires { native_value(usual.*field.member); }) {
                    defaults[field.name] = native_value(usual.*field.member);
                }
            });
            for (const DocumentedRow& row : shapes.at(S::kName)) {
                std::size_t at = 0;
                for (const std::string& key : row.keys) {
                    if (!defaults.contains(key)) continue;
                    at = row.text.find(defaults[key], at);
                    ASSERT_NE(at, std::string::npos) << S::kName << ": " << key << " is "
                                                     << defaults[key] << ", not in " << row.text;
                    at += defaults[key].size();
                }
            }
        },
        AnalyticShapes{});
}

TEST(NativeFields, RandomShapesOfEveryTypeComeBack) {
    testing::Random random(18);
    SceneDescription scene = testing::empty_scene();
    scene.materials.push_back({Material{}, {}});
    for_shape_types(
        [&]<class S>(const S&) {
            for (int i = 0; i < 40; ++i) {
                const S shape = testing::RandomShape<S>::make({random, i % 2 == 1});
                scene.objects[0].parts.push_back({AnyShape{shape}, {}, MaterialId{0}, {}, {}});
            }
        },
        AnalyticShapes{});
    testing::expect_round_trip(scene);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
