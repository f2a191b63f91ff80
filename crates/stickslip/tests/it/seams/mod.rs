//! What the library lets others add without a change to itself, shown by toys: a friction law that keeps a state.

mod law_with_state;
