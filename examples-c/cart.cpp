// A pendulum on a cart built from bodies, and the parts of its equations compared with those
// derived by hand.
#include <array>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "pc.hpp"

namespace {

constexpr double big = 2.0, m = 1.0, l = 0.5, g = 9.81;

pc::model cart()
{
    pc::model model("Pendulum on a cart");
    model.description("A mass on a rod, hung from a cart").parameter("M", big).parameter("m", m);
    model.parameter("l", l).parameter("g", g).coordinate("s", 0.0).coordinate("φ", 0.5);
    model.body("cart", "M", {"s", "0", "0"});
    model.body("bob", "m", {"s + l*sin(φ)", "0", "-l*cos(φ)"}).body_force("bob", {"0", "0", "-m*g"});
    model.start("s'", 0.2).end_time(10.0).check();
    return model;
}

// s'' and φ'' of (M + m) s'' + m l cos φ φ'' = m l φ'² sin φ and cos φ s'' + l φ'' = −g sin φ.
std::array<double, 2> accelerations(const std::array<double, 4> &y)
{
    const double sine = std::sin(y[1]), cosine = std::cos(y[1]);
    const double s = (m * l * y[3] * y[3] * sine + m * g * sine * cosine) / (big + m * sine * sine);
    return {s, -(g * sine + cosine * s) / l};
}

double largest(pc::view<const double> numbers)
{
    double largest = 0.0;
    for (const double number : numbers) {
        largest = std::fmax(largest, std::fabs(number));
    }
    return largest;
}

bool has(const std::string &text, const std::string &part) { return text.find(part) != std::string::npos; }

} // namespace

int main()
{
    try {
        const pc::model model = cart();
        pc::system system(model);
        const std::array<double, 4> y{0.1, 0.7, 0.3, -1.1};
        const auto [s, phi] = accelerations(y);
        const double ydot[] = {y[2], y[3], s, phi};
        const double rounding = 1e-13; // about ten operations with numbers up to 20
        bool right = system.names() == std::vector<std::string>{"s", "φ", "s'", "φ'"};
        right = right && system.start().second == pc::vector{0.0, 0.5, 0.2, 0.0};

        pc::vector rates = system.rhs(0.0, y);
        for (std::size_t i = 0; i < 4; i++) {
            rates[i] -= ydot[i];
        }
        right = right && largest(rates) < rounding && largest(system.residual(0.0, y, ydot)) < 10 * rounding;

        // M = ((M + m, m l cos φ), (m l cos φ, m l²)), and its momenta.
        const double across = m * l * std::cos(y[1]);
        const pc::vector mass = system.mass_matrix(0.0, y), p = system.to_momenta(0.0, y);
        right = right && largest({mass[0] - big - m, mass[1] - across, mass[2] - across}) < rounding;
        right = right && std::fabs(mass[3] - m * l * l) < rounding;
        right = right && std::fabs(p[2] - (big + m) * y[2] - across * y[3]) < rounding;
        right = right && std::fabs(p[3] - across * y[2] - m * l * l * y[3]) < rounding;
        right = right && std::fabs(system.to_quasi_velocities(0.0, p)[3] - y[3]) < rounding;
        const pc::vector canonical = pc::system(model, PC_CANONICAL).rhs(0.0, p);
        right = right && std::fabs(canonical[0] - y[2]) + std::fabs(canonical[1] - y[3]) < rounding;
        // (φ, s') = ∂s'/∂p_φ, an entry of the inverse of M.
        const double bracket = -across / ((big + m) * m * l * l - across * across);
        right = right && std::fabs(system.bracket("φ", "s'", 0.0, y) - bracket) < rounding;
        right = right && system.operator_count() == 2 && largest(system.structure_coefficients(0.0, y)) == 0.0;

        // The Jacobian: dense, by its zero pattern, as a product, and of a kernel.
        const pc::vector dense = system.jacobian(0.0, y), sparse = system.sparse_jacobian(0.0, y);
        const pc::sparsity at = system.jacobian_pattern();
        pc::vector product = system.jvp(0.0, y, ydot), copied(16);
        std::size_t entries = 0;
        for (std::size_t j = 0; j < 4; j++) {
            for (std::size_t k = at.column_starts[j]; k < at.column_starts[j + 1]; k++, entries++) {
                product[at.row_indices[k]] -= sparse[k] * ydot[j];
                right = right && sparse[k] == dense[at.row_indices[k] + 4 * j];
            }
        }
        pc::kernel kernel(system);
        right = right && entries == sparse.size() && entries < 16 && largest(product) < 100 * rounding;
        right = right && kernel.jacobian(0.0, y, copied) == 0 && copied == dense;

        // Other parameters in the same equations.
        pc::vector values = system.parameters(), heavier(4);
        system.set_parameter(0, 1e9);
        values[0] = 1e9;
        kernel.set_parameters(values);
        right = right && kernel(0.0, y, heavier) == 0 && heavier == system.rhs(0.0, y);
        right = right && std::fabs(heavier[3] + g * std::sin(y[1]) / l) < 1e-6; // up to m/M

        // The equations printed, as JSON, as source, and the text that the calls wrote.
        const auto [header, source] = system.emit_c("cart", 10.0);
        right = right && has(system.print(), "M + m") && system.print(PC_JSON).front() == '{';
        right = right && has(system.theory(PC_TEXT, 2, {"cos(φ)"}), "momentum of s'") && has(system.theory(), "Routh");
        right = right && has(system.canonical_variables({{"x", "s + l*sin(φ)"}, {"P", "p_s"}}), "canonical proved");
        right = right && has(header, "cart_rhs") && has(source, "#ifdef CART_MAIN");
        const std::string text = model.text(), force = "\"bob\".\"force\" = [\"0\", \"0\", \"-m*g\"]";
        right = right && has(text, force) && pc::model::parse(text).text() == text;
        std::cout << system.print();
        return right ? 0 : 1;
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
