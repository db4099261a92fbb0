#pragma once
// Ports that exist only because a connection names them, for tasks that accept any type of a list.
//
//     template <class T>
//     struct Logged { std::string stream; size_t samples = 0; };          // what the task keeps with a port
//     framework::DynamicInputs<types::SampleTypes, Logged> inputs_{this};
//
//     InputPortBase* makeInput(const std::string& name, OutputPortBase& source) override {
//         return inputs_.make(name, source, source.path());               // null: samples of another type
//     }
//     void updateHook() override {
//         inputs_.forEach([&]<class Input>(Input& input) {
//             for (typename Input::Carried sample{}; input.port.readNew(sample);) ++input.kept.samples;
//         });
//     }
#include <list>
#include <string>
#include <tuple>
#include <type_traits>
#include <variant>

#include "components/framework/Port.hpp"
#include "types/samples/Samples.hpp"

namespace insonify::framework {

/** For tasks that keep nothing with a port. */
template <class T>
struct KeepsNothing {};

/** One port of DynamicInputs, with the data that its task keeps for it. */
template <class T, template <class> class Kept>
struct DynamicInput final {
    using Sample = T;
    using Carried = types::Carried<T>;

    template <class... Args>
    DynamicInput(TaskContext* owner, const std::string& name, const std::string& doc, const Args&... with)
        : port(owner, name, doc, Need::Optional), kept{with...} {}
    InputPort<Carried> port;
    Kept<T> kept{};
};

/** One port of DynamicOutputs, with the data that its task keeps for it. */
template <class T, template <class> class Kept>
struct DynamicOutput final {
    using Sample = T;
    using Carried = types::Carried<T>;

    DynamicOutput(TaskContext* owner, const std::string& name, const std::string& doc) : port(owner, name, doc) {}
    OutputPort<Carried> port;
    Kept<T> kept{};
};

template <class Samples, template <class> class Kept = KeepsNothing>
class DynamicInputs;
template <class Samples, template <class> class Kept = KeepsNothing>
class DynamicOutputs;

/** Input ports of the types T, made when connections name them. */
template <class... T, template <class> class Kept>
class DynamicInputs<std::tuple<T...>, Kept> {
public:
    explicit DynamicInputs(TaskContext* owner) : owner_(owner) {}

    /** Makes a port for the samples of `source`, with task data constructed from `with`. Returns null if the type is
     *  not in T. */
    template <class... Args>
    InputPortBase* make(const std::string& name, const OutputPortBase& source, const Args&... with) {
        InputPortBase* made = nullptr;
        const std::string doc = "samples of " + source.path();
        (void)((source.type() == typeid(types::Carried<T>) && (made = makeOne<T>(name, doc, with...))) || ...);
        return made;
    }
    bool empty() const { return inputs_.empty(); }
    /** Calls `use` with each DynamicInput, in the order of creation. */
    template <class Use>
    void forEach(Use&& use) {
        for (auto& input : inputs_) std::visit(use, input);
    }
    template <class Use>
    void forEach(Use&& use) const {
        for (const auto& input : inputs_) std::visit(use, input);
    }

private:
    template <class Sample, class... Args>
    InputPortBase* makeOne(const std::string& name, const std::string& doc, const Args&... with) {
        using Input = DynamicInput<Sample, Kept>;
        return &std::get<Input>(inputs_.emplace_back(std::in_place_type<Input>, owner_, name, doc, with...)).port;
    }

    TaskContext* owner_;
    std::list<std::variant<DynamicInput<T, Kept>...>> inputs_;  ///< A list, because ports must not move.
};

/** Output ports of the types T, made when connections name them. */
template <class... T, template <class> class Kept>
class DynamicOutputs<std::tuple<T...>, Kept> {
public:
    using Output = std::variant<DynamicOutput<T, Kept>...>;

    explicit DynamicOutputs(TaskContext* owner) : owner_(owner) {}

    /** Makes a port for samples of that type. */
    template <class Sample>
    DynamicOutput<Sample, Kept>& make(const std::string& name, const std::string& doc) {
        using One = DynamicOutput<Sample, Kept>;
        return std::get<One>(outputs_.emplace_back(std::in_place_type<One>, owner_, name, doc));
    }
    /** Makes a port of the first type for which `is(std::type_identity<T>{})`; null if there is none. The port does not
     *  move. */
    Output* makeFirst(const std::string& name, const std::string& doc, const auto& is) {
        const bool made = ((is(std::type_identity<T>{}) && (make<T>(name, doc), true)) || ...);
        return made ? &outputs_.back() : nullptr;
    }
    /** Calls `use` with each DynamicOutput, in the order of creation. */
    template <class Use>
    void forEach(Use&& use) {
        for (Output& output : outputs_) std::visit(use, output);
    }
    template <class Use>
    void forEach(Use&& use) const {
        for (const Output& output : outputs_) std::visit(use, output);
    }

private:
    TaskContext* owner_;
    std::list<Output> outputs_;  ///< A list, because ports must not move.
};

}  // namespace insonify::framework
