// The parts that the handwritten monitors share: their result, and the reward.

namespace ByHand
{
    using System;

    public enum Verdict
    {
        Satisfied,
        Holding,
        Pending,
        Violated
    }

    /// <summary>The result of a step.</summary>
    public struct Result
    {
        public int State;
        public string Label;
        public Verdict Verdict;
        public bool Accepting;
        public bool Done;
        public double Progress;
        public double Reward;
        public double Robustness;
        public string Limiting;
        public int FailedStep;    // 0 for none

        public string LabelEnglish
        {
            get { return Monitor.English[State]; }
        }

        // A trace fails only at the one clause that it must not break.
        public string FailedClause
        {
            get { return FailedStep == 0 ? null : "keep alive"; }
        }

        public string FailedAtom
        {
            get { return FailedStep == 0 ? null : "alive"; }
        }
    }

    /// <summary>An automaton that runs over one episode after another.</summary>
    public abstract class Episode
    {
        protected readonly double LevelSize;
        protected int State;
        protected double Progress;
        protected bool Done;
        private int _steps;
        protected int FailedStep;

        protected Episode(double levelSize)
        {
            LevelSize = levelSize;
        }

        public void Reset()
        {
            State = 0;
            Progress = 0.0;
            Done = false;
            _steps = 0;
            FailedStep = 0;
        }

        /// <summary>Count a step with this progress; returns its reward.</summary>
        protected double Advance(double progress, bool violated, bool ends, int limit)
        {
            _steps++;
            if (violated && FailedStep == 0) FailedStep = _steps;
            double best = progress > Progress ? progress : Progress;
            double reward = 0.0;
            if (!Done)
            {
                reward = best - Progress - 1.0 / limit;
                if (violated) reward -= (double)(limit - _steps) / limit;
            }
            Progress = best;
            Done = Done || ends || _steps >= limit;
            return reward;
        }

        /// <summary>Closeness in [-1, 1]: 1 at the target, 0 at 1 m, -1 from the level's size on.</summary>
        protected double Near(double distance)
        {
            if (distance < 1.0) return distance > 0.0 ? 1.0 - distance : 1.0;
            if (distance > LevelSize) return -1.0;
            double rest = (LevelSize - distance) / (LevelSize - 1.0);
            return rest * rest - 1.0;
        }

        /// <summary>Throws where the value of a signal is not finite.</summary>
        protected static void Check(string name, double value)
        {
            if (double.IsNaN(value) || double.IsInfinity(value)) throw new ArgumentException("not finite", name);
        }
    }
}
