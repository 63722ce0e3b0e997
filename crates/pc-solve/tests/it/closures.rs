//! Vector fields given by closures.

use pc_solve::{Failure, Integration, Options, Pattern, VectorField, from_fn};

fn still(_t: f64, _y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    ydot.fill(0.0);
    Ok(())
}

#[test]
fn only_given_closures_are_available() {
    let mut bare = from_fn(2, still);
    assert!(!bare.has_jacobian() && !bare.has_jvp() && !bare.has_parameter_jacobian());
    assert!(!bare.has_projection() && bare.sparsity().is_none());
    assert_eq!(bare.parameters_len(), 0);
    let message = |result: Result<(), Failure>| result.unwrap_err().to_string();
    let room = &mut [0.0; 4];
    assert_eq!(message(bare.jacobian(0.0, &[0.0; 2], room)), "this vector field was given no Jacobian");
    assert_eq!(
        message(bare.sparse_jacobian(0.0, &[0.0; 2], room)),
        "this vector field was given no Jacobian"
    );
    assert_eq!(
        message(bare.jvp(0.0, &[0.0; 2], &[0.0; 2], room)),
        "this vector field was given no product with its Jacobian"
    );
    assert_eq!(
        message(bare.parameter_jacobian(0.0, &[0.0; 2], room)),
        "this vector field was given no derivative by parameters"
    );
    bare.project(0.0, room).unwrap();
    assert_eq!(*room, [0.0; 4]);

    // Closures may be added in any order.
    let pattern = Pattern::from_columns(2, [vec![1], vec![0, 1]]);
    let mut full = from_fn(2, still)
        .with_projection(|t, y| {
            y.fill(t);
            Ok(())
        })
        .with_parameters(2, |t, y, by_parameters| {
            by_parameters.copy_from_slice(&[t, y[0], y[1], 4.0]);
            Ok(())
        })
        .with_names(["x"])
        .with_jvp(|t, y, v, product| {
            product.copy_from_slice(&[t * y[0], v[1]]);
            Ok(())
        })
        .with_sparse_jacobian(|t, y, values| {
            values.copy_from_slice(&[t, y[0], y[1]]);
            Ok(())
        })
        .with_sparsity(pattern.clone());
    assert_eq!(full.sparsity(), Some(&pattern));
    assert!(full.has_jacobian() && full.has_jvp() && full.has_parameter_jacobian() && full.has_projection());
    assert_eq!(full.parameters_len(), 2);
    assert_eq!((full.component_name(0), full.component_name(1)), ("x".to_owned(), "y[1]".to_owned()));
    full.jacobian(3.0, &[5.0, 7.0], room).unwrap();
    assert_eq!(*room, [0.0, 3.0, 5.0, 7.0], "scattered");
    full.parameter_jacobian(1.0, &[2.0, 3.0], room).unwrap();
    assert_eq!(*room, [1.0, 2.0, 3.0, 4.0]);
    let mut two = [0.0; 2];
    full.jvp(2.0, &[3.0, 0.0], &[0.0, 5.0], &mut two).unwrap();
    assert_eq!(two, [6.0, 5.0]);
    full.project(9.0, &mut two).unwrap();
    assert_eq!(two, [9.0, 9.0]);

    // A dense closure is the dense Jacobian; sparse entries are gathered from it without a sparse
    // closure.
    let dense = |_t: f64, _y: &[f64], jacobian: &mut [f64]| {
        jacobian.copy_from_slice(&[1.0, 2.0, 3.0, 4.0]);
        Ok(())
    };
    full.with_jacobian(dense).jacobian(0.0, &[0.0; 2], room).unwrap();
    assert_eq!(*room, [1.0, 2.0, 3.0, 4.0]);
    let mut three = [0.0; 3];
    let mut gathered = from_fn(2, still).with_jacobian(dense).with_sparsity(pattern);
    gathered.sparse_jacobian(0.0, &[0.0; 2], &mut three).unwrap();
    assert_eq!(three, [2.0, 3.0, 4.0]);
    let mut patternless = from_fn(2, still).with_sparse_jacobian(still);
    assert_eq!(
        message(patternless.jacobian(0.0, &[0.0; 2], room)),
        "this vector field was given no zero pattern, but a sparse Jacobian"
    );
}

/// An integration of closures that are `Send` is `Send`.
#[test]
fn integrations_of_closures_can_be_sent() {
    let rate = vec![1.0];
    let field = from_fn(1, move |_t, _y, ydot| {
        ydot.copy_from_slice(&rate);
        Ok(())
    })
    .with_jvp(|_t, _y, _v, product| {
        product.fill(0.0);
        Ok(())
    });
    let mut cvode = Integration::new(field, 0.0, &[0.0], &Options::default()).unwrap();
    let end = std::thread::spawn(move || cvode.state_at(1.0).map(|y| y[0]).unwrap());
    assert!((end.join().unwrap() - 1.0).abs() < 1e-9);
}
