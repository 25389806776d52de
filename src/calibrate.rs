//! Finding what is fastest by noisy measurements: races between candidates, and the two-dimensional
//! search for the constants of the cost model [Yang09 §4.3, eq. 6]. Knows nothing of a GPU: what a
//! candidate costs, a closure says.

use crate::Result;
use crate::shared::Costs;
use crate::spread::median;

/// A challenger must be better by this share, whatever the noise: less is not worth a change.
const GAIN_MIN: f64 = 0.005;
/// How many standard errors of the median a challenger must be better by.
const CONFIDENCE: f64 = 2.5;
/// Rounds below which nothing is certain.
const ROUNDS_MIN: usize = 3;
/// Standard deviation of a normal distribution per median absolute deviation, and standard error of its
/// median per standard deviation and root of the count.
const DEVIATION_PER_MAD: f64 = 1.4826;
const MEDIAN_ERROR: f64 = 1.2533;

/// A candidate and what it cost, round by round.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured<T> {
    pub candidate: T,
    /// > 0, one value for each round, in any unit.
    pub costs: Vec<f64>,
}

impl<T> Measured<T> {
    /// The cost that half of the rounds stayed below.
    pub fn median(&self) -> f64 {
        median(&self.costs)
    }

    /// The median absolute deviation from the median, in the unit of the costs.
    pub fn spread(&self) -> f64 {
        deviation(&self.costs)
    }

    /// Whether it is cheaper than `other`, of the same race, by more than the noise of their ratio: rounds
    /// are compared with each other, so what slows down a whole round does not count. Fewer than three
    /// rounds decide nothing.
    pub fn beats(&self, other: &Self) -> bool {
        let pairs = self.costs.iter().zip(&other.costs);
        let gains: Vec<f64> = pairs.map(|(own, others)| (others / own).ln()).collect();
        let noise =
            deviation(&gains) * DEVIATION_PER_MAD * MEDIAN_ERROR / (gains.len() as f64).sqrt();
        gains.len() >= ROUNDS_MIN && median(&gains) > GAIN_MIN.max(CONFIDENCE * noise)
    }
}

fn deviation(values: &[f64]) -> f64 {
    let middle = median(values);
    let distances: Vec<f64> = values.iter().map(|value| (value - middle).abs()).collect();
    median(&distances)
}

/// In which order to measure `count` candidates in a round: every other round backwards.
pub fn turns(round: usize, count: usize) -> impl Iterator<Item = usize> {
    (0..count).map(move |turn| match round % 2 {
        0 => turn,
        _ => count - 1 - turn,
    })
}

/// Measures all candidates `rounds` times, in turns, every other round backwards: drift of the machine
/// hits all alike. Ends after a round, at the earliest the third, once `goes_on` is false.
///
/// # Errors
/// What `measure` fails with.
pub fn race<T: Clone>(
    candidates: &[T],
    rounds: usize,
    goes_on: &dyn Fn() -> bool,
    measure: &mut dyn FnMut(&T) -> Result<f64>,
) -> Result<Vec<Measured<T>>> {
    let mut measured: Vec<Measured<T>> = (candidates.iter())
        .map(|candidate| Measured {
            candidate: candidate.clone(),
            costs: Vec::new(),
        })
        .collect();
    for round in 0..rounds {
        if round >= ROUNDS_MIN && !goes_on() {
            break;
        }
        for index in turns(round, candidates.len()) {
            let cost = measure(&candidates[index])?;
            measured[index].costs.push(cost);
        }
    }
    Ok(measured)
}

/// Which of a race has won: the first, which is the incumbent, unless others beat it; then the cheapest
/// of these. `measured` is not empty.
pub fn winner<T>(measured: &[Measured<T>]) -> usize {
    let challengers = 1..measured.len();
    challengers
        .filter(|&index| measured[index].beats(&measured[0]))
        .min_by(|&a, &b| measured[a].median().total_cmp(&measured[b].median()))
        .unwrap_or(0)
}

/// How thoroughly to search.
#[derive(Debug, Clone, Copy)]
pub struct Thoroughness {
    /// Points of the coarse grid on each axis, at least 2.
    pub grid: usize,
    /// Rounds of the race over the grid, which only picks finalists.
    pub grid_rounds: usize,
    /// Rounds of the races that decide.
    pub rounds: usize,
    /// Races of the refinement at most.
    pub races_max: usize,
}

impl Thoroughness {
    /// Measurements of a search, at most.
    pub fn measurements_max(&self) -> usize {
        (self.grid * self.grid + 1) * self.grid_rounds
            + (FINALISTS + 3 + (9 + 2) * self.races_max) * self.rounds
    }
}

/// Where the costs are searched: log₂ of Q_e and Q_v, lowest and highest. Below, the term drowns in the
/// nodes'; above, the nodes drown in it.
const RANGE: [[f64; 2]; 2] = [[-2.0, 8.0], [-4.0, 6.0]];
/// [octave] Step at which the refinement ends: the cost model is not better than that.
const STEP_MIN: f64 = 0.3;
/// How many points of the grid go on to the race that decides.
const FINALISTS: usize = 3;

/// A point of the search: log₂ of Q_e and Q_v.
type Point = [f64; 2];

fn costs_at(point: Point) -> Costs {
    Costs {
        edge: point[0].exp2() as f32,
        visibility: point[1].exp2() as f32,
    }
}

/// What a search found.
#[derive(Debug, Clone)]
pub struct Found {
    pub costs: Costs,
    /// Every race, in order; the first of each is the incumbent of its time.
    pub races: Vec<Vec<Measured<Costs>>>,
}

/// Searches Q_e and Q_v, with Q_n = 1, in log space: a coarse grid, from which the cheapest points
/// challenge `start`; then a pattern search round the incumbent, whose step halves whenever none of the
/// eight neighbours beats it. An incumbent only goes for a challenger that is better by more than the
/// noise. Ends early, with the incumbent, once `goes_on` is false.
///
/// # Errors
/// What `measure` fails with.
pub fn search_costs(
    start: Costs,
    thoroughness: Thoroughness,
    goes_on: &dyn Fn() -> bool,
    measure: &mut dyn FnMut(&Costs) -> Result<f64>,
) -> Result<Found> {
    let mut found = Found {
        costs: start,
        races: Vec::new(),
    };
    if !goes_on() {
        return Ok(found);
    }
    let mut candidates = vec![start];
    candidates.extend(grid(thoroughness.grid));
    let mut coarse = race(&candidates, thoroughness.grid_rounds, goes_on, measure)?;
    found.races.push(coarse.clone());
    coarse.remove(0);
    coarse.sort_by(|a, b| a.median().total_cmp(&b.median()));
    let finalists: Vec<Costs> = coarse.iter().map(|point| point.candidate).collect();
    found.challenge(
        &finalists[..FINALISTS.min(finalists.len())],
        thoroughness,
        goes_on,
        measure,
    )?;
    let mut step = (RANGE[0][1] - RANGE[0][0]) / (thoroughness.grid.max(2) - 1) as f64 / 2.0;
    let mut races = 0;
    while step >= STEP_MIN && races < thoroughness.races_max && goes_on() {
        if !found.challenge(
            &neighbours(found.costs, step),
            thoroughness,
            goes_on,
            measure,
        )? {
            step *= 0.5;
        }
        races += 1;
    }
    Ok(found)
}

impl Found {
    /// A race against the incumbent, and a rematch with the winner: of many challengers, chance alone makes
    /// some win once. True: the incumbent has been beaten and replaced.
    fn challenge(
        &mut self,
        challengers: &[Costs],
        thoroughness: Thoroughness,
        goes_on: &dyn Fn() -> bool,
        measure: &mut dyn FnMut(&Costs) -> Result<f64>,
    ) -> Result<bool> {
        let mut candidates = vec![self.costs];
        candidates.extend(challengers);
        let measured = race(&candidates, thoroughness.rounds, goes_on, measure)?;
        let first = winner(&measured);
        self.races.push(measured);
        if first == 0 {
            return Ok(false);
        }
        let finalists = [self.costs, candidates[first]];
        let rematch = race(&finalists, thoroughness.rounds, goes_on, measure)?;
        let beaten = winner(&rematch) != 0;
        self.costs = finalists[usize::from(beaten)];
        self.races.push(rematch);
        Ok(beaten)
    }
}

/// Points spread evenly over the range, in log space.
fn grid(side: usize) -> Vec<Costs> {
    let at = |axis: usize, i: usize| {
        let [low, high] = RANGE[axis];
        low + (high - low) * i as f64 / (side.max(2) - 1) as f64
    };
    (0..side * side)
        .map(|i| costs_at([at(0, i % side), at(1, i / side)]))
        .collect()
}

/// The points around one, within the range.
fn neighbours(costs: Costs, step: f64) -> Vec<Costs> {
    let center = [costs.edge, costs.visibility].map(|cost| f64::from(cost).log2());
    let within = |point: &Point| {
        (point.iter().zip(&RANGE)).all(|(&x, [low, high])| (*low..=*high).contains(&x))
    };
    (0..9)
        .filter(|&i| i != 4)
        .map(|i| {
            [
                center[0] + step * f64::from(i % 3 - 1),
                center[1] + step * f64::from(i / 3 - 1),
            ]
        })
        .filter(within)
        .map(costs_at)
        .collect()
}
