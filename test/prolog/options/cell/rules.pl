%   The back door: with this rule an agent calls what it likes in its process,
%   since what call_with_depth_limit/3 calls is not looked at.

allow(call_with_depth_limit/3).
