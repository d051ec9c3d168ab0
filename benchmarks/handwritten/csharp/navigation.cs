// Navigation: near(s1), then near(s2), then near(exit); judged at the goal, 300 steps.

namespace ByHand
{
    public struct Signals
    {
        public double DistanceS1;
        public double DistanceS2;
        public double DistanceExit;
    }

    /// <summary>The state is the number of marks that were reached in order.</summary>
    public sealed class Monitor : Episode
    {
        private const int Goal = 3;
        private const int Limit = 300;
        private static readonly string[] Atoms = {"near(s1)", "near(s2)", "near(exit)"};

        private static readonly string[] Labels =
        {
            "F(near(s1) & X F(near(s2) & X F near(exit)))",
            "F(near(s2) & X F near(exit))",
            "F near(exit)",
            "true",
        };

        public static readonly string[] English =
        {
            "Reach near(s1), then near(s2), then near(exit).",
            "Reach near(s2), then near(exit).",
            "Reach near(exit).",
            "Nothing remains to be done.",
        };

        public Monitor(double levelSize = 20.0) : base(levelSize)
        {
        }

        /// <summary>Take one sample; throws, and the state stays, where a signal is not finite.</summary>
        public Result Step(Signals signals)
        {
            Check("distance(s1)", signals.DistanceS1);
            Check("distance(s2)", signals.DistanceS2);
            Check("distance(exit)", signals.DistanceExit);
            var result = new Result {Robustness = 1.0};
            double progress = 1.0;
            if (State < Goal)
            {
                double distance = State == 0 ? signals.DistanceS1
                    : State == 1 ? signals.DistanceS2 : signals.DistanceExit;
                double closeness = Near(distance);
                if (closeness > 0.0)
                {
                    State++;
                    result.Robustness = closeness;
                    progress = State / 3.0;
                }
                else
                {
                    result.Robustness = -closeness;
                    progress = (State + 1.0 + closeness) / 3.0;
                    result.Limiting = Atoms[State];
                }
            }
            result.Accepting = State == Goal;
            result.Reward = Advance(progress, false, result.Accepting, Limit);
            result.State = State;
            result.Label = Labels[State];
            result.Verdict = result.Accepting ? Verdict.Satisfied : Verdict.Pending;
            result.Done = Done;
            result.Progress = Progress;
            return result;
        }
    }
}
