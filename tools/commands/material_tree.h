#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace reradiant {

/// The questions of "Classification According to Reflectance" (Weidlich and Wilkie, "Rendering
/// with Layered Materials", Eurographics 2011 tutorial).
enum class Question { ReflectsEnvironment, EnvironmentBlurred, HighlightSmall, OneHighlight };
inline constexpr std::size_t QUESTION_COUNT = 4;

/// The question's name as an option (`reflects-environment`) and as a sentence.
struct QuestionText {
    const char* option;
    const char* sentence;
};
const std::array<QuestionText, QUESTION_COUNT>& question_texts();

/// A `Classification` is the tree's answer for one material.
struct Classification {
    std::string top, base;            ///< as the source words them
    std::string letters;              ///< classes of "Final Classification", best first
    std::vector<Question> asked = {}; ///< in the order in which the tree asks them
};

/// Goes down the tree, asking as it goes. The tree is followed as its transcription has it, though
/// that is slightly garbled: two leaves are the same (smooth over smooth metal) and none is a rough
/// top over a coloured base (c) or a smooth one over rough metal (e).
Classification classify_material(const std::function<bool(Question)>& answer);

/// One of the classes of layered materials that the letters a to h of the tree stand for.
struct MaterialClass {
    char letter;
    const char* name;
    const char* ranges;               ///< parameters that the source gives for it
    std::vector<const char*> presets; ///< the first is the class's own, to start from
};
const std::vector<MaterialClass>& material_classes();
/// Returns the class of a letter a to h.
const MaterialClass& material_class(char letter);

} // namespace reradiant
