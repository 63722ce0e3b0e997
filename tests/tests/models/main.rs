//! Claims of every built-in model, and some of the mechanisms: a model is derived once, and all claims are made of what was derived.
//!
//! A claim is a function of a [`Derived`](derived::Derived) model in the module of its topic; `claims` lists them and makes them. What
//! they find of a model they write into its [`Findings`](findings::Findings), of which `together` says what holds of all models at once.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod backends;
mod bound_programs;
mod claims;
mod derived;
mod derived_equations;
#[path = "../common/divergence.rs"]
mod divergence;
#[path = "../common/estimated.rs"]
mod estimated;
mod estimates;
mod findings;
mod forms_agree;
mod free_forms;
mod kept_costs;
mod measures;
mod pages;
mod printed_pages;
#[path = "../common/read_back.rs"]
mod read_back;
mod reference_states;
mod subject;
mod taylor_references;
mod theory;
mod together;

/// A test for each of the models, which are named as functions are; they are those of `$models`.
macro_rules! models {
    ($module:ident, $models:ident, $($model:ident),* $(,)?) => {
        mod $module {
            use crate::claims::$models;

            $(
                #[test]
                fn $model() {
                    $models.assert_claims(stringify!($model));
                }
            )*

            #[test]
            fn none_is_left_out() {
                let mut tested = [$(stringify!($model)),*];
                tested.sort_unstable();
                let mut models = $models.tests();
                models.sort_unstable();
                assert_eq!(tested[..], models[..]);
            }
        }
    };
}

models![
    built_in,
    BUILT_IN,
    heavy_top_lagrange,
    heavy_top_kovalevskaya,
    heavy_top_goryachev_chaplygin,
    heavy_top_euler,
    heavy_top_euler_symmetric,
    heavy_top_quaternion,
    euler_top,
    rigid_body_spring,
    gravity_gradient,
    gimbals,
    reaction_wheels,
    quadrotor,
    spherical_pendulum_cartesian,
    spherical_pendulum_meridian,
    double_pendulum_cartesian,
    double_pendulum_links,
    turning_wire,
    turning_hoop,
    rotating_oscillator,
    charged_particle,
    charged_particle_induction,
    damped_oscillator,
    damped_oscillator_scaled_frame,
    relativistic_particle,
    relativistic_constant_force,
    pendulum_chain,
    pendulum_chain_cartesian,
    toda_chain,
    chaplygin_sleigh,
    vertical_disk,
    vertical_disk_driven,
    tilted_disk,
    nonholonomic_particle,
    suslov,
    suslov_in_gravity,
    turntable,
    turntable_accelerated,
    ball_in_cylinder,
    snakeboard,
    snakeboard_driven,
    carriage,
    voronets,
    voronets_rheonomic,
    stiff_sleigh,
    bouncing_ball,
    stick_slip_block,
    rocking_block,
    stick_slip_sleigh,
    rocking_disk,
    appell_hamel,
];

models![
    mechanism,
    MECHANISMS,
    arm_on_wall,
    crank_rocker,
    rattleback,
    slider_crank,
    squeezer,
    squeezer_loop,
    whipple_bicycle,
];
