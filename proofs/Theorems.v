(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* What exactvo-verify promises: definitions and statements, no proofs. Checker.v has a checker for each statement and
   proves that it keeps the promise. A `point` is made of fractions, as files have them; a `vec` of real numbers. What no
   promise mentions (multipliers, joints, separations) only helps the checkers. *)
Require Import Reals QArith Qreals List Bool.
Import ListNotations.
Open Scope R_scope.

(* --- Plane --- *)
Definition vec := (R * R)%type.
Definition add (a b : vec) : vec := (fst a + fst b, snd a + snd b).
Definition sub (a b : vec) : vec := (fst a - fst b, snd a - snd b).
Definition scale (s : R) (a : vec) : vec := (s * fst a, s * snd a).
Definition dot (a b : vec) : R := fst a * fst b + snd a * snd b.
Definition apart (r : R) (x y : vec) := r * r <= dot (sub x y) (sub x y).        (* r >= 0: their distance is at least r *)
Definition mix (s : R) (a b : vec) : vec := add (scale (1 - s) a) (scale s b).   (* from a (s = 0) to b (s = 1) *)
Definition point := (Q * Q)%type.
Definition real (p : point) : vec := (Q2R (fst p), Q2R (snd p)).

Inductive hull (ps : list point) : vec -> Prop :=       (* convex hull; of two points: the segment between them *)
| corner p : In p ps -> hull ps (real p)
| chord x y s : hull ps x -> hull ps y -> 0 <= s <= 1 -> hull ps (mix s x y).

Inductive shape :=
| Polygon (vertices : list point)                       (* their hull: segments are polygons of two vertices *)
| Disc (centre : point) (radius : Q)
| Ellipse (centre : point) (l11 l21 l22 : Q).           (* the unit disc under [l11 0; l21 l22], moved to the centre *)
(* The image of the disc of radius sqrt(m) under the same map. *)
Definition in_ellipse (m : R) (c : point) (l11 l21 l22 : Q) (x : vec) := exists a b,
  a * a + b * b <= m /\ x = add (real c) (Q2R l11 * a, Q2R l21 * a + Q2R l22 * b).
Definition inside (b : shape) (x : vec) : Prop := match b with
  | Polygon vs => hull vs x
  | Disc c r => 0 <= Q2R r /\ dot (sub x (real c)) (sub x (real c)) <= Q2R r * Q2R r
  | Ellipse c l11 l21 l22 => in_ellipse 1 c l11 l21 l22 x
  end.

(* --- HalfPlane: velocities v with normal.v >= offset keep the robot clear of a moving body until the horizon --- *)
Record half_plane := { body : shape; body_velocity : point; position : point; radius : Q;
  horizon : option Q;                                   (* None: for ever *)
  normal : point; offset : Q; margin : Q }.
Definition moment (h : option Q) (t : R) := 0 <= t /\ match h with Some q => t <= Q2R q | None => True end.
Definition keeps_clear (c : half_plane) := forall v t o,
  Q2R (offset c) <= dot (real (normal c)) v -> moment (horizon c) t -> inside (body c) o ->
  let there := add o (scale t (real (body_velocity c))) in let here := add (real (position c)) (scale t v) in
  apart (Q2R (radius c)) here there /\     (* and an empty strip across the normal, margin / |normal| wide, parts them: *)
  forall y, dot (sub y here) (sub y here) <= Q2R (radius c) * Q2R (radius c) ->
    dot (real (normal c)) there + Q2R (margin c) <= dot (real (normal c)) y.
(* Two robots: c is of one (its body and margin do not count); p, r are place and radius of the other, whose half-plane has the
   opposite normal and the offset `other`. *)
Definition keep_each_other_clear (c : half_plane) (p : point) (r other : Q) := forall v w t,
  Q2R (offset c) <= dot (real (normal c)) v -> Q2R other <= dot (scale (-1) (real (normal c))) w -> moment (horizon c) t ->
  apart (Q2R (radius c) + Q2R r) (add (real (position c)) (scale t v)) (add (real p) (scale t w)).

(* --- Program: half-planes that must hold or may give, the disc and box of the speed, the velocity wished for --- *)
Record row := { row_normal : point; row_offset : Q; soft : bool }.
Record program := { rows : list row; disc : option Q; box_x : option Q; box_y : option Q; wish : point }.
Definition at_most (x : R) (b : option Q) := match b with Some q => x <= Q2R q | None => True end.
Definition slow (p : program) (v : vec) := match disc p with Some d => 0 <= Q2R d /\ dot v v <= Q2R d * Q2R d | None => True end /\
  at_most (Rabs (fst v)) (box_x p) /\ at_most (Rabs (snd v)) (box_y p).
Definition holds (give : R) (v : vec) (c : row) := Q2R (row_offset c) - give <= dot (real (row_normal c)) v.
Definition allowed (give : R) (p : program) (v : vec) :=   (* hard ones hold, soft ones are broken by at most `give` *)
  slow p v /\ Forall (fun c => holds (if soft c then give else 0) v c) (rows p).
(* `pull`, `against`: multipliers, one a row; `mu`: that of the disc. *)
Record choice := { velocity : point; gap : Q; violation : Q; pull : list Q; mu : Q; against : list Q }.
Definition off_wish (p : program) (v : vec) := dot (sub v (real (wish p))) (sub v (real (wish p))).
Definition is_nearest (p : program) (c : choice) := allowed 0 p (real (velocity c)) /\
  forall w, allowed 0 p w -> off_wish p (real (velocity c)) <= off_wish p w + Q2R (gap c).
Definition is_farthest (p : program) (c : choice) := allowed 0 p (real (velocity c)) /\
  forall w, allowed 0 p w -> dot (real (wish p)) w <= dot (real (wish p)) (real (velocity c)) + Q2R (gap c).
Definition gives_least (p : program) (c : choice) := allowed (Q2R (violation c)) p (real (velocity c)) /\
  (forall w, ~ allowed 0 p w) /\ forall w give, allowed give p w -> Q2R (violation c) - Q2R (gap c) <= give.

(* --- Route and Chain: a disc among walls and polygons with holes --- *)
Inductive obstacle := Wall (line : list point) | Solid (rings : list (list point)).
Definition edge := (point * point)%type.
Fixpoint sides_from (a : point) (ps : list point) : list edge := match ps with [] => [] | b :: r => (a, b) :: sides_from b r end.
Definition sides (ps : list point) : list edge := match ps with [] => [] | a :: r => sides_from a r end.
Definition ring_sides (ps : list point) : list edge := match ps with [] => [] | a :: r => sides_from a (r ++ [a]) end.
Definition edges_of (o : obstacle) : list edge := match o with Wall l => sides l | Solid rs => flat_map ring_sides rs end.
Definition on (e : edge) (x : vec) := hull [fst e; snd e] x.
(* Does the ray from x upward cross the side ab? Of its ends the left one counts, the right one does not. *)
Definition le (a b : R) : bool := if Rle_dec a b then true else false.
Definition lt (a b : R) : bool := if Rlt_dec a b then true else false.
Definition line (a b : vec) (t : R) : R := snd a + (snd b - snd a) / (fst b - fst a) * (t - fst a).
Definition crosses (x a b : vec) : bool := xorb (le (fst a) (fst x)) (le (fst b) (fst x)) && lt (snd x) (line a b (fst x)).
Definition odd (es : list edge) (x : vec) : bool :=     (* is the number of crossings odd? *)
  fold_right (fun e sum => xorb (crosses x (real (fst e)) (real (snd e))) sum) false es.

(* Bodies stand for an obstacle: every point of its edges lies in one of them. *)
Definition held_by (bs : list shape) (o : obstacle) := forall e x, In e (edges_of o) -> on e x -> exists b, In b bs /\ inside b x.
(* The disc has room at x: x is in no polygon, and no edge is nearer than r. *)
Definition outside (os : list obstacle) (x : vec) := forall o, In o os -> match o with Wall _ => True | Solid _ => odd (edges_of o) x = false end.
Definition room (os : list obstacle) (r : R) (x : vec) := outside os x /\ forall o e y, In o os -> In e (edges_of o) -> on e y -> apart r x y.
Definition near (d : R) (x y : vec) := Rabs (fst y - fst x) < d /\ Rabs (snd y - snd x) < d.
Definition continuous (p : R -> vec) := forall t, 0 <= t <= 1 -> forall e, 0 < e ->
  exists d, 0 < d /\ forall s, 0 <= s <= 1 -> Rabs (s - t) < d -> near e (p t) (p s).
Definition way (os : list obstacle) (r : R) (s g : vec) := exists p, continuous p /\ p 0 = s /\ p 1 = g /\ forall t, 0 <= t <= 1 -> room os r (p t).

(* A corner of a closed chain, the obstacle and the edge of it that it lies on, and whether a gap or that edge leads on. *)
Record joint := { spot : point; obstacle_no : nat; edge_no : nat; gap_follows : bool }.

(* --- Step and Run: all robots move at once, straight and evenly, past edges and discs that do too or stand still --- *)
Record motion := { from : point; to : point; size : Q }.
Definition place (m : motion) (s : R) : vec := mix s (real (from m)) (real (to m)).
Definition parted (s : R) (a b : motion) := apart (Q2R (size a) + Q2R (size b)) (place a s) (place b s).
Definition keeps_apart (os : list obstacle) (discs ms : list motion) := forall s, 0 <= s <= 1 ->
  ForallOrdPairs (parted s) ms /\ forall m, In m ms -> room os (Q2R (size m)) (place m s) /\ forall d, In d discs -> parted s d m.
Definition moves (sizes : list Q) (a b : list point) : list motion :=
  map (fun x => {| size := fst x; from := fst (snd x); to := snd (snd x) |}) (combine sizes (combine a b)).
Fixpoint all_steps (P : list point -> list point -> Prop) (rows : list (list point)) : Prop :=
  match rows with a :: ((b :: _) as r) => P a b /\ all_steps P r | _ => True end.
Definition with_start {A} (rows : list A) := match rows with a :: _ => a :: rows | [] => [] end.   (* at rest in the first row, then the steps *)

(* --- Braking: the robots choose velocities, take them for a step (s), and then all brake: in each step of braking a
   robot keeps the share 1 - step / tau of its velocity (tau: s) --- *)
Record driver := { now_at : point; had : point; chosen : point; its_radius : Q; its_most : Q }.   (* had, chosen: velocities *)
Definition pole := (point * Q)%type.                    (* a disc at rest: centre and radius *)
Fixpoint braked (step tau : R) (d : driver) (n : nat) : vec * vec :=   (* place and velocity after n steps *)
  match n with
  | O => (real (now_at d), real (chosen d))
  | S k => let (x, v) := braked step tau d k in (add x (scale step v), scale (1 - step / tau) v)
  end.
Definition while_braking (step tau : R) (d : driver) (n : nat) (s : R) : vec :=   (* at share s of the step after n steps *)
  let (x, v) := braked step tau d n in add x (scale (s * step) v).
Definition no_longer (l : R) (v : vec) := dot v v <= l * l.
Definition gentle (step tau : R) (d : driver) :=        (* its velocity changes by its_most (m/s^2) at most: now, and in each step of braking *)
  no_longer (Q2R (its_most d) * step) (sub (real (chosen d)) (real (had d))) /\
  forall n, no_longer (Q2R (its_most d) * step) (sub (snd (braked step tau d (S n))) (snd (braked step tau d n))).
Definition can_brake (os : list obstacle) (poles : list pole) (step tau : Q) (ds : list driver) :=
  0 < Q2R step <= Q2R tau /\
  (forall d, In d ds -> gentle (Q2R step) (Q2R tau) d) /\
  forall n s, 0 <= s <= 1 -> let there := fun d => while_braking (Q2R step) (Q2R tau) d n s in
    ForallOrdPairs (fun a b => apart (Q2R (its_radius a) + Q2R (its_radius b)) (there a) (there b)) ds /\
    forall d, In d ds -> room os (Q2R (its_radius d)) (there d) /\
      forall c, In c poles -> apart (Q2R (its_radius d) + Q2R (snd c)) (there d) (real (fst c)).

(* --- Sweep: bodies of convex parts, each grown by a reach, that move along polynomials between two moments --- *)
Record part := { corners : list point; reach : Q }.     (* corners seen from the place of the body *)
Inductive basis := Powers | Bezier | Spline.            (* of the time since the start (s); control points; those of a uniform B-spline *)
Record trip := { leave : Q; arrive : Q; meant : basis; points : list point; parts : list part }.   (* straight: Bezier, two points *)
Definition under_way (m : trip) (t : R) := Q2R (leave m) <= t <= Q2R (arrive m).
Fixpoint mixed_once (share : nat -> R) (ps : list vec) : list vec :=   (* each two neighbours, the first two by share 0 *)
  match ps with a :: ((b :: _) as r) => mix (share O) a b :: mixed_once (fun i => share (S i)) r | _ => [] end.
Fixpoint mixed (share : nat -> nat -> R) (n : nat) (ps : list vec) : vec :=   (* n times, until one is left: de Casteljau, de Boor *)
  match n with O => hd (0, 0) ps | S k => mixed share k (mixed_once (share n) ps) end.
Definition on_way (m : trip) (passed u : R) : vec :=    (* u: the share of the time that has passed; without points: (0, 0) *)
  let ps := map real (points m) in let n := Nat.pred (length ps) in match meant m with
  | Powers => fold_right (fun p more => add p (scale passed more)) (0, 0) ps
  | Bezier => mixed (fun _ _ => u) n ps
  | Spline => mixed (fun n i => (u + INR (n - 1 - i)) / INR n) n ps
  end.
Definition at_time (m : trip) (t s : R) : vec :=        (* no time to go: the whole way at once, s is the share of it; of powers the start alone *)
  let l := Q2R (leave m) in let a := Q2R (arrive m) in on_way m (t - l) (if Req_EM_T l a then s else (t - l) / (a - l)).
(* x is in the body then. *)
Definition covers (m : trip) (t s : R) (x : vec) := exists p y, In p (parts m) /\ hull (corners p) y /\
  let d := sub x (add (at_time m t s) y) in dot d d <= Q2R (reach p) * Q2R (reach p).
Definition never_meet (a b : trip) := forall t s x, under_way a t -> under_way b t -> 0 <= s <= 1 -> covers a t s x -> ~ covers b t s x.
Definition stays_out (a : trip) (o : obstacle) := forall t s x, under_way a t -> 0 <= s <= 1 -> covers a t s x ->
  outside [o] x /\ forall e, In e (edges_of o) -> ~ on e x.
(* A direction that parts two of them, numbered from 0 (of an obstacle: its edges), between two moments. *)
Record separation := { part_no : nat; other_no : nat; since : Q; until : Q; direction : point; width : Q }.

(* --- Turn: such a body drives and turns at once, at constant rates in its own frame, past an obstacle --- *)
Record drive := { sets_out : Q; halts : Q; place_then : point; heads : point;   (* velocity at the start, m/s *)
  turns : Q; body_parts : list part }.                  (* rad/s; corners as they lie at the start *)
Definition left_of (v : vec) : vec := (- snd v, fst v).  (* a quarter turn to the left *)
(* Where the point y of a body at o is after t s, if it has the velocity v then and turns at w. *)
Definition carried (o v : vec) (w t : R) (y : vec) : vec :=
  let way := if Req_EM_T w 0 then scale t v else add (scale (sin (w * t) / w) v) (scale ((1 - cos (w * t)) / w) (left_of v)) in
  add (add o way) (add (scale (cos (w * t)) y) (scale (sin (w * t)) (left_of y))).
Definition driven (d : drive) : R -> vec -> vec := carried (real (place_then d)) (real (heads d)) (Q2R (turns d)).
Definition drives_clear (d : drive) (o : obstacle) := forall t p y x,
  0 <= t <= Q2R (halts d) - Q2R (sets_out d) -> In p (body_parts d) -> hull (corners p) y ->
  (let off := sub x (driven d t y) in dot off off <= Q2R (reach p) * Q2R (reach p)) -> outside [o] x /\ forall e, In e (edges_of o) -> ~ on e x.

(* --- Wheels: the axle, at o, looks along h, and holds a speed and a turn rate for a step (s). The body, within `body_reach`
   of the axle, stays in a disc about a point that goes straight from where the point `ahead` of the axle is to where it comes --- *)
Record wheels := { body_reach : Q; ahead : Q; most_speed : Q; time_step : Q }.
Definition stays_within (k : wheels) (r : R) := forall o h speed turn, dot h h = 1 ->
  let T := Q2R (time_step k) in let after := carried o (scale speed h) turn in let ahead_at t := after t (scale (Q2R (ahead k)) h) in
  no_longer (Q2R (most_speed k) * T) (sub (ahead_at T) (ahead_at 0)) -> Rabs (turn * T) < PI ->
  forall t y, 0 <= t <= T -> no_longer (Q2R (body_reach k)) y -> no_longer r (sub (after t y) (mix (t / T) (ahead_at 0) (ahead_at T))).

(* --- The promises --- *)
Module Type Verifier.
  Parameter half_plane_holds : half_plane -> bool.
  Parameter half_plane_sound : forall c, half_plane_holds c = true -> keeps_clear c.
  Parameter pair_holds : half_plane -> point -> Q -> Q -> bool.
  Parameter pair_sound : forall c p r other, pair_holds c p r other = true -> keep_each_other_clear c p r other.
  Parameter contains : shape -> list point -> Q -> bool.
  Parameter contains_sound : forall c l11 l21 l22 ps m, contains (Ellipse c l11 l21 l22) ps m = true ->
    forall x, hull ps x -> in_ellipse (1 - Q2R m) c l11 l21 l22 x.
  Parameter hold : list shape -> obstacle -> bool.
  Parameter hold_sound : forall bs o, hold bs o = true -> held_by bs o.
  Parameter nearest farthest least : program -> choice -> bool.
  Parameter nearest_sound : forall p c, nearest p c = true -> is_nearest p c.
  Parameter farthest_sound : forall p c, farthest p c = true -> is_farthest p c.
  Parameter least_sound : forall p c, least p c = true -> gives_least p c.
  Parameter pinned : program -> point -> bool.
  Parameter pinned_sound : forall p v, pinned p v = true -> allowed 0 p (real v).
  Parameter contradicted : program -> choice -> bool.
  Parameter contradicted_sound : forall p c, contradicted p c = true -> forall w, ~ allowed 0 p w.
  Parameter route : list obstacle -> Q -> list point -> bool.
  Parameter route_sound : forall os r ps, route os r ps = true ->
    forall e x, In e (sides ps) -> on e x -> room os (Q2R r) x.
  Parameter chain : list obstacle -> Q -> point -> point -> list joint -> bool.
  Parameter chain_sound : forall os r s g js, chain os r s g js = true ->
    room os (Q2R r) (real s) /\ room os (Q2R r) (real g) /\ ~ way os (Q2R r) (real s) (real g).
  Parameter blocked : list obstacle -> Q -> point -> nat -> option nat -> bool.   (* by an edge, or inside a polygon *)
  Parameter blocked_sound : forall os r x o e, blocked os r x o e = true -> ~ room os (Q2R r) (real x).
  Parameter starts : list obstacle -> list motion -> bool.
  Parameter starts_sound : forall os ms, starts os ms = true -> forall m, In m ms -> outside os (place m 0).
  Parameter step : list obstacle -> list motion -> list motion -> bool.
  Parameter step_sound : forall os discs ms, step os discs ms = true -> (forall m, In m ms -> outside os (place m 0)) -> keeps_apart os discs ms.
  Parameter run : list obstacle -> list motion -> list Q -> list (list point) -> bool.   (* also of one row *)
  Parameter run_sound : forall os discs sizes rows, run os discs sizes rows = true ->
    Forall (fun r => length r = length sizes) rows /\ all_steps (fun a b => keeps_apart os discs (moves sizes a b)) (with_start rows).
  Parameter brakes : list obstacle -> list pole -> Q -> Q -> list driver -> bool.
  Parameter brakes_sound : forall os poles step tau ds, brakes os poles step tau ds = true ->
    (forall d, In d ds -> outside os (real (now_at d))) -> can_brake os poles step tau ds.
  Parameter sweep : trip -> trip -> list separation -> bool.
  Parameter sweep_sound : forall a b l, sweep a b l = true -> never_meet a b.
  Parameter sweep_past : trip -> obstacle -> list separation -> bool.
  Parameter sweep_past_sound : forall a o l, sweep_past a o l = true -> stays_out a o.
  Parameter turn_past : drive -> obstacle -> list separation -> bool.
  Parameter turn_past_sound : forall d o l, turn_past d o l = true -> drives_clear d o.
  Parameter wheels_fit : wheels -> Q -> bool.
  Parameter wheels_sound : forall k r, wheels_fit k r = true -> stays_within k (Q2R r).
End Verifier.
