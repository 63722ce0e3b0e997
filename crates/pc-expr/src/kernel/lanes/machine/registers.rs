//! Allocation of registers.
//!
//! If no register is free, the value with the latest next use is evicted [Belady 1966], and stored unless
//! it is in memory already.

use super::assembler::{Assembler, EncodeError, Home, Last, Vector};

/// A value in memory is loaded into a register if it is read again within this many lines.
const SOON: u32 = 24;
/// The next use of a value that is not read again.
pub(super) const NEVER: u32 = u32::MAX;

/// The registers and the values.
pub(super) struct Registers {
    /// The value in each register.
    owner: Vec<Option<u32>>,
    locked: u32,
    /// The register of each value, and where it is in memory.
    place: Vec<Option<Vector>>,
    home: Vec<Option<Home>>,
    /// The lines that read each value, and how many of them have passed.
    uses: Vec<Vec<u32>>,
    over: Vec<usize>,
    /// The rows that are free again, and the first row that was never used.
    free_rows: Vec<u32>,
    next_row: u32,
    /// Whether a value has a row that becomes free after its last use.
    spilled: Vec<bool>,
    /// The first of the rows for arguments of calls, if there are calls.
    for_calls: Option<u32>,
}

impl Registers {
    pub(super) fn new(
        vectors: usize,
        home: Vec<Option<Home>>,
        uses: Vec<Vec<u32>>,
        next_row: u32,
    ) -> Registers {
        let values = home.len();
        Registers {
            owner: vec![None; vectors],
            locked: 0,
            place: vec![None; values],
            home,
            over: vec![0; values],
            uses,
            free_rows: Vec::new(),
            next_row,
            spilled: vec![false; values],
            for_calls: None,
        }
    }

    /// The number of rows used.
    pub(super) fn rows(&self) -> u32 {
        self.next_row
    }

    /// The next line after this one that reads a value.
    pub(super) fn next_use(&mut self, value: u32, line: u32) -> u32 {
        let (uses, over) = (&self.uses[value as usize], &mut self.over[value as usize]);
        while uses.get(*over).is_some_and(|&at| at <= line) {
            *over += 1;
        }
        uses.get(*over).copied().unwrap_or(NEVER)
    }

    pub(super) fn is_last_use(&mut self, value: u32, line: u32) -> bool {
        self.next_use(value, line) == NEVER
    }

    pub(super) fn place(&self, value: u32) -> Option<Vector> {
        self.place[value as usize]
    }

    pub(super) fn home(&self, value: u32) -> Option<Home> {
        self.home[value as usize]
    }

    pub(super) fn set_home(&mut self, value: u32, home: Home) {
        self.home[value as usize] = Some(home);
    }

    /// Reserves the registers of these values until the end of the line.
    pub(super) fn lock(&mut self, values: &[u32]) {
        for &value in values {
            if let Some(vector) = self.place(value) {
                self.locked |= 1 << vector;
            }
        }
    }

    /// A register to write to, reserved until the end of the line.
    pub(super) fn take(&mut self, assembler: &mut Assembler, line: u32) -> Result<Vector, EncodeError> {
        let unlocked: Vec<usize> = (0..self.owner.len()).filter(|&i| self.locked & (1 << i) == 0).collect();
        let free = unlocked.iter().copied().find(|&i| self.owner[i].is_none());
        let chosen = match free {
            Some(vector) => vector,
            None => {
                let mut latest = (0, unlocked[0]);
                for &i in &unlocked {
                    let next = self.owner[i].map_or(NEVER, |value| self.next_use(value, line));
                    if next > latest.0 {
                        latest = (next, i);
                    }
                }
                self.give_up(latest.1, assembler, line)?;
                latest.1
            }
        };
        self.locked |= 1 << chosen;
        Ok(chosen as Vector)
    }

    /// Empties a register.
    fn give_up(&mut self, vector: usize, assembler: &mut Assembler, line: u32) -> Result<(), EncodeError> {
        let Some(value) = self.owner[vector].take() else { return Ok(()) };
        if self.home(value).is_none() && !self.is_last_use(value, line) {
            let row = self.row();
            assembler.store(row, vector as Vector)?;
            self.home[value as usize] = Some(Home::Row(row));
            self.spilled[value as usize] = true;
        }
        self.place[value as usize] = None;
        Ok(())
    }

    /// Empties all registers.
    pub(super) fn give_up_all(&mut self, assembler: &mut Assembler, line: u32) -> Result<(), EncodeError> {
        (0..self.owner.len()).try_for_each(|vector| self.give_up(vector, assembler, line))
    }

    /// A row that nothing else uses.
    pub(super) fn row(&mut self) -> u32 {
        self.free_rows.pop().unwrap_or_else(|| {
            self.next_row += 1;
            self.next_row - 1
        })
    }

    /// The first of `count` successive rows, which all calls share.
    pub(super) fn rows_in_sequence(&mut self, count: u32) -> u32 {
        *self.for_calls.get_or_insert_with(|| {
            self.next_row += count;
            self.next_row - count
        })
    }

    /// The register of a value, which is loaded if necessary.
    pub(super) fn in_register(
        &mut self,
        value: u32,
        assembler: &mut Assembler,
        line: u32,
    ) -> Result<Vector, EncodeError> {
        if let Some(vector) = self.place(value) {
            self.locked |= 1 << vector;
            return Ok(vector);
        }
        let vector = self.take(assembler, line)?;
        self.load(vector, value, assembler)?;
        self.put(value, vector);
        Ok(vector)
    }

    /// Loads a value from memory, without recording its register.
    pub(super) fn load(
        &mut self,
        vector: Vector,
        value: u32,
        assembler: &mut Assembler,
    ) -> Result<(), EncodeError> {
        let home = self.home(value).unwrap_or_else(|| unreachable!("a value is somewhere"));
        assembler.load(vector, home)
    }

    /// A value as the last operand of an instruction: read from memory, unless it is in a register or
    /// is read again soon.
    pub(super) fn last(
        &mut self,
        value: u32,
        assembler: &mut Assembler,
        line: u32,
    ) -> Result<Last, EncodeError> {
        let next = self.next_use(value, line);
        match (self.place(value), self.home(value)) {
            (None, Some(home)) if next == NEVER || next - line > SOON => Ok(Last::Memory(home)),
            _ => Ok(Last::Register(self.in_register(value, assembler, line)?)),
        }
    }

    /// Records that a value is in a register.
    pub(super) fn put(&mut self, value: u32, vector: Vector) {
        self.owner[usize::from(vector)] = Some(value);
        self.place[value as usize] = Some(vector);
    }

    /// Ends a line, and frees the registers of values that it has read for the last time.
    pub(super) fn end_line(&mut self, operands: &[u32], line: u32) {
        self.locked = 0;
        for &value in operands {
            self.release(value, line);
        }
    }

    /// Frees the register and the row of a value that is not read after this line.
    pub(super) fn release(&mut self, value: u32, line: u32) {
        if !self.is_last_use(value, line) {
            return;
        }
        if let Some(vector) = self.place[value as usize].take() {
            self.owner[usize::from(vector)] = None;
        }
        if std::mem::take(&mut self.spilled[value as usize])
            && let Some(Home::Row(row)) = self.home[value as usize].take()
        {
            self.free_rows.push(row);
        }
    }
}
