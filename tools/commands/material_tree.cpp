#include "tools/commands/material_tree.h"

#include <algorithm>
#include <stdexcept>

namespace reradiant {

const std::array<QuestionText, QUESTION_COUNT>& question_texts() {
    static const std::array<QuestionText, QUESTION_COUNT> texts{{
        {"reflects-environment", "Does it reflect its environment?"},
        {"environment-blurred", "Is the reflected environment blurred?"},
        {"highlight-small", "Is the highlight small?"},
        {"one-highlight", "Is there one highlight only?"},
    }};
    return texts;
}

Classification classify_material(const std::function<bool(Question)>& answer) {
    std::vector<Question> asked;
    const auto yes = [&](Question question) {
        asked.push_back(question);
        return answer(question);
    };
    const auto leaf = [&](const char* top, const char* base, const char* letters) {
        return Classification{top, base, letters, asked};
    };
    if (yes(Question::ReflectsEnvironment)) {
        if (yes(Question::EnvironmentBlurred))
            return leaf("smooth", "metallic, smooth", "d");
        if (yes(Question::HighlightSmall))
            return leaf("smooth", "metallic, smooth", "d");
    } else if (yes(Question::HighlightSmall)) {
        return leaf("smooth", "coloured surface", "ab");
    }
    if (yes(Question::OneHighlight))
        return leaf("rough", "metallic, smooth", "f");
    return leaf("rough", "metallic, rough", "gh");
}

const std::vector<MaterialClass>& material_classes() {
    static const std::vector<MaterialClass> classes{
        {'a',
         "glossy paint",
         "top layer: roughness 0.01 to 4 degrees, IOR 1.35 to 1.7, clear; base: diffuse",
         {"glossy-paint", "acrylic-lacquer", "ceramic-glaze"}},
        {'b',
         "tinted glazing",
         "as a, with a varnish that absorbs",
         {"tinted-glazing", "red-lacquer"}},
        {'c',
         "frosted paint",
         "top layer: roughness 5 to 40 degrees; base: diffuse",
         {"frosted-paint", "frosted-acrylic-paint", "sugar", "latex"}},
        {'d',
         "metal foil",
         "top layer: roughness 3 to 4 degrees; base: metal of up to 2 degrees",
         {"metal-foil", "brass"}},
        {'e',
         "metallic paint",
         "top layer: smooth; base: rough metal; the colour is the top layer's absorption",
         {"metallic-paint", "car-paint", "gold-metallic-paint"}},
        {'f',
         "frosted metal",
         "top layer: rough; base: smooth metal, which looks rough through it",
         {"frosted-metal", "gold-paint", "blue-metallic"}},
        {'g',
         "patina",
         "top layer: transparent, very rough, IOR 1.3 to 1.5; base: rough metal",
         {"patina", "silver-paint"}},
        {'h',
         "multi-layer",
         "more than two layers; fanned-out highlights",
         {"multi-layer", "house-paint"}},
    };
    return classes;
}

const MaterialClass& material_class(char letter) {
    const auto& classes = material_classes();
    const auto found = std::find_if(classes.begin(), classes.end(),
                                    [&](const MaterialClass& c) { return c.letter == letter; });
    if (found == classes.end())
        throw std::invalid_argument(std::string("no class is called '") + letter +
                                    "'; there are a to h");
    return *found;
}

} // namespace reradiant
