//! How busy the machine was with other work while something was measured.

use std::fs;

/// Processor time so far, in the kernel's ticks.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Ticks {
    /// Of all processors, whatever they did.
    all: u64,
    /// Of it, busy.
    busy: u64,
    /// Of it, by this process.
    own: u64,
}

/// Watches from its making on.
#[derive(Debug)]
pub struct Busy(Option<Ticks>);

impl Busy {
    pub fn watch() -> Self {
        Self(ticks())
    }

    /// [0, 1] The share of all processors' time that other processes took since then. None: the system does not tell.
    pub fn others(&self) -> Option<f64> {
        share(self.0?, ticks()?)
    }
}

fn share(before: Ticks, after: Ticks) -> Option<f64> {
    let since = |pick: fn(&Ticks) -> u64| pick(&after).saturating_sub(pick(&before)) as f64;
    let all = since(|ticks| ticks.all);
    (all > 0.0)
        .then(|| ((since(|ticks| ticks.busy) - since(|ticks| ticks.own)) / all).clamp(0.0, 1.0))
}

/// None: the system has no /proc, or not Linux's.
fn ticks() -> Option<Ticks> {
    let machine = fs::read_to_string("/proc/stat").ok()?;
    let own = fs::read_to_string("/proc/self/stat").ok()?;
    parse(&machine, &own)
}

fn parse(machine: &str, own: &str) -> Option<Ticks> {
    // "cpu" user nice system idle iowait irq softirq steal; guests are in user.
    let fields = machine.lines().next()?.split_whitespace().skip(1).take(8);
    let fields: Vec<u64> = fields
        .map(|field| field.parse().ok())
        .collect::<Option<_>>()?;
    let all = fields.iter().sum();
    let idle = fields.get(3)? + fields.get(4)?;
    // The name in brackets may hold spaces; user and system time are fields 14 and 15, the name is the second.
    let (_, behind_name) = own.rsplit_once(')')?;
    let mut times = behind_name.split_whitespace().skip(11);
    let own = times.next()?.parse::<u64>().ok()? + times.next()?.parse::<u64>().ok()?;
    Some(Ticks {
        all,
        busy: all - idle,
        own,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_by_hand() {
        let stat = |user: u64, idle: u64| format!("cpu  {user} 0 10 {idle} 5 0 0 0 0 0\ncpu0 1\n");
        let own = |user: u64| format!("7 (a ) b) S 1 2 3 4 5 6 7 8 9 10 {user} 3 0 0\n");
        let before = parse(&stat(100, 1000), &own(20)).unwrap();
        assert_eq!((before.all, before.busy, before.own), (1115, 110, 23));
        // 200 ticks later: 100 busy, 60 of them our own.
        let after = parse(&stat(200, 1100), &own(80)).unwrap();
        assert_eq!(share(before, after), Some(0.2));
        assert_eq!(share(before, before), None);
        assert_eq!(parse("", ""), None);
    }
}
