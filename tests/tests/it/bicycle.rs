//! The bicycle's eigenvalues over its speed, from the full nonlinear model with its contacts [Meijaard, Papadopoulos, Ruina,
//! Schwab, Proc. R. Soc. A 463 (2007) 1955].

use pc_analysis::{Leaf, Linearization, Linearizer, RootLocus, SteadyOptions};
use pc_mech::{Graph, Matrix, VectorField};
use pc_model::{Builtin, Document, Model, Source};

const BICYCLE: &str = include_str!("../../mechanisms/whipple-bicycle.toml");

/// Table 2: weave, or two real ones instead at rest, capsize and castering, for 0, 1, … 10 m/s; the conjugate of weave is left out.
const TABLE_2: [[(f64, f64); 4]; 11] = [
    [
        (3.131_643_247_906_56, 0.0),
        (5.530_943_717_653_93, 0.0),
        (-3.131_643_247_906_56, 0.0),
        (-5.530_943_717_653_93, 0.0),
    ],
    weave((3.526_961_709_900_70, 0.807_740_275_199_30), -3.134_231_250_665_78, -7.110_080_146_374_42),
    weave((2.682_345_175_127_45, 1.680_662_965_906_75), -3.071_586_456_415_14, -8.673_879_848_317_35),
    weave((1.706_756_056_639_75, 2.315_824_473_843_25), -2.633_661_372_536_67, -10.351_014_672_459_2),
    weave((0.413_253_315_211_25, 3.079_108_186_032_06), -1.429_444_273_613_26, -12.158_614_265_764_47),
    weave((-0.775_341_882_195_85, 4.464_867_713_788_23), -0.322_866_429_004_09, -14.078_389_692_798_22),
    weave((-1.526_444_865_841_42, 5.876_730_605_987_09), -0.004_066_900_769_70, -16.085_371_230_980_26),
    weave((-2.138_756_442_583_62, 7.195_259_133_298_05), 0.102_681_705_747_66, -18.157_884_661_252_62),
    weave((-2.693_486_835_810_97, 8.460_379_713_969_31), 0.143_278_797_657_13, -20.279_408_943_945_69),
    weave((-3.216_754_022_524_85, 9.693_773_515_317_91), 0.157_901_840_309_17, -22.437_885_590_408_58),
    weave((-3.720_168_404_372_87, 10.906_811_394_762_87), 0.161_053_386_531_72, -24.624_596_350_174_04),
];

const fn weave((re, im): (f64, f64), capsize: f64, castering: f64) -> [(f64, f64); 4] {
    [(re, im), (re, -im), (capsize, 0.0), (castering, 0.0)]
}

/// A bicycle that rides straight, at any speed.
struct Straight {
    linearizer: Linearizer,
    model: Model,
    names: Vec<String>,
}

impl Straight {
    fn new() -> Straight {
        let mut model = Model::new(Document::parse(Source::new("bicycle.toml", BICYCLE)).unwrap());
        model.set_start("roll", 0.0).unwrap();
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let equations = assembly.equations().unwrap();
        let mut leaf = Leaf::of(&assembly.system);
        leaf.positions = assembly.held_positions().into_iter().map(|(_, f)| f).collect();
        let linearizer = Linearizer::new(&equations, &leaf, &[]).unwrap();
        Straight { linearizer, names: model.start_names(), model }
    }

    fn at(&mut self, speed: f64) -> Linearization {
        self.model.set("v0", speed).unwrap();
        let values = self.model.start().unwrap();
        let place = |name: &String| self.names.iter().position(|known| known == name).unwrap();
        let start: Vec<f64> = self.linearizer.names().iter().map(|name| values[place(name)]).collect();
        let parameters: Vec<f64> = self.model.parameters().map(|(_, value)| value).collect();
        self.linearizer.set_parameters(&parameters);
        self.linearizer.steady(0.0, &start, &SteadyOptions::default()).unwrap()
    }
}

/// Fourteen digits are printed; numbers up to some hundred are rounded some thousand times.
const PRINTED: f64 = 1e-11;

#[test]
fn eigenvalues_over_speed_are_those_of_table_2() {
    let mut bicycle = Straight::new();
    let mut locus = RootLocus::default();
    for (speed, row) in (0u8..).map(f64::from).zip(&TABLE_2) {
        let linear = bicycle.at(speed);
        assert_eq!(linear.components, ["φ", "δ", "roll", "steer", "wheel"]);
        assert_eq!(linear.distance, 0.0, "the start is steady");
        let found = linear.spectrum.eigenvalues();
        for &(re, im) in row {
            let distance = |l: &pc_analysis::Eigenvalue| (l.real - re).hypot(l.imaginary - im);
            let nearest = found.iter().map(distance).fold(f64::INFINITY, f64::min);
            assert!(nearest < PRINTED, "{speed} m/s: {re} + {im}i by {nearest}");
        }
        // The fifth is the speed's own.
        assert_eq!(linear.spectrum.zero_blocks(), [1]);
        locus.push(speed, Some(found)).unwrap();
    }
    // Each branch keeps to its kind from 1 m/s on: weave twice, capsize, castering, and the speed that stays.
    let last = |branch: &Vec<Option<pc_analysis::Eigenvalue>>| branch.last().unwrap().unwrap();
    for branch in locus.branches() {
        let (first, last) = (branch[1].unwrap(), last(branch));
        let expected = match (first.imaginary != 0.0, first.real) {
            (true, _) => (-3.720_168_404_372_87, 10.906_811_394_762_87),
            (false, 0.0) => (0.0, 0.0),
            (false, real) if real > -4.0 => (0.161_053_386_531_72, 0.0),
            (false, _) => (-24.624_596_350_174_04, 0.0),
        };
        let apart = (last.real - expected.0).abs().max((last.imaginary.abs() - expected.1).abs());
        assert!(apart < PRINTED, "{first:?} leads to {last:?}");
    }
}

/// M q̈ + v C1 q̇ + (g K0 + v² K2) q = 0 in lean and steer, with the coefficients printed for the benchmark; the rear wheel is
/// apart from these.
#[test]
fn coefficients_are_those_of_the_benchmark() {
    let mass = [[80.817_22, 2.319_413_322_087_09], [2.319_413_322_087_09, 0.297_841_881_996_86]];
    let c1 = [[0.0, 33.866_413_914_924_94], [-0.850_356_414_569_78, 1.685_403_973_975_60]];
    let k0 = [[-80.95, -2.599_516_852_498_72], [-2.599_516_852_498_72, -0.803_294_884_586_18]];
    let k2 = [[0.0, 76.597_345_895_732_22], [0.0, 2.654_315_237_946_04]];
    let mut bicycle = Straight::new();
    let gravity = 9.81;
    for speed in [0.0, 1.0, 7.3] {
        let second = bicycle.at(speed).second_order.unwrap();
        assert_eq!(second.coordinates[..2], ["φ", "δ"]);
        let near = |found: &Matrix<f64>, expected: &dyn Fn(usize, usize) -> f64| {
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let (found, expected) = (found[(i, j)], expected(i, j));
                assert!((found - expected).abs() < PRINTED * expected.abs().max(1.0), "{found} {expected}");
            }
            assert!([(0, 2), (2, 0), (1, 2), (2, 1)].iter().all(|&place| found[place].abs() < PRINTED));
        };
        near(&second.mass, &|i, j| mass[i][j]);
        near(&second.velocity, &|i, j| speed * c1[i][j]);
        near(&second.stiffness, &|i, j| gravity * k0[i][j] + speed * speed * k2[i][j]);
    }
}

/// The built-in model has its weight from `[gravity]`, this text from a potential: the rates are the same, and down in pictures is
/// the z of the paper.
#[test]
fn gravity_of_the_built_in_model_is_the_potential() {
    let built_in = Builtin::named("whipple-bicycle").unwrap().document().unwrap();
    let written = Document::parse(Source::new("bicycle.toml", BICYCLE)).unwrap();
    let (graph, other) = (Graph::new(), Graph::new());
    let (weight, potential) = (Model::new(built_in), Model::new(written));
    let (of_weight, of_potential) = (weight.assemble(&graph).unwrap(), potential.assemble(&other).unwrap());
    let z = of_weight.system.gravity().map(|component| component.to_string());
    assert_eq!(z, ["0", "0", "g"]);
    let (mut falls, start) = weight.compile(&of_weight).unwrap();
    let (mut climbs, same) = potential.compile(&of_potential).unwrap();
    assert_eq!((falls.names(), &start), (climbs.names(), &same));
    for part in [0.0, 0.1, 0.2, 0.3] {
        let y: Vec<f64> = (1u8..).zip(&start).map(|(i, y)| y + part * f64::from(i).sin()).collect();
        let [mut a, mut b] = [vec![0.0; y.len()], vec![0.0; y.len()]];
        falls.rhs(0.0, &y, &mut a).unwrap();
        climbs.rhs(0.0, &y, &mut b).unwrap();
        let largest = a.iter().fold(0.0f64, |largest, rate| largest.max(rate.abs()));
        // Both are rounded some thousand times, and solved for.
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= 1e-10 * largest), "{a:?}\n{b:?}");
    }
}
