/// Numbers in sets, each known by its smallest.
pub(super) struct Union(Vec<u32>);

impl Union {
    pub fn new(n: usize) -> Union {
        Union((0..n as u32).collect())
    }

    /// The smallest of the set of a number.
    pub fn top(&mut self, i: usize) -> usize {
        let mut at = i as u32;
        while self.0[at as usize] != at {
            let above = self.0[self.0[at as usize] as usize];
            self.0[at as usize] = above;
            at = above;
        }
        at as usize
    }

    /// Makes one of the sets of two numbers.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.top(a), self.top(b));
        self.0[a.max(b)] = a.min(b) as u32;
    }
}
