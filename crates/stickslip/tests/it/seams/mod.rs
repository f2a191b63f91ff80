//! What the library lets others add without a change to itself, shown by toys: a friction law that keeps a state, a field beside the displacements. And what goes with what, tried one by one.

mod combinations;
mod law_with_state;
mod second_field;
