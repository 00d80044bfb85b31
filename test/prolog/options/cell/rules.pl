%   A deliberate hole: with this rule an agent calls any goal in its process,
%   since the rules do not check what call_with_depth_limit/3 calls.

allow(call_with_depth_limit/3).
