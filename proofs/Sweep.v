(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* Certificates that moving bodies never meet: for each piece of time and each two parts a direction that parts them. *)
Require Import Reals QArith Qreals List Bool Arith Lra Psatz.
From ExactVO Require Import Theorems Plane Parity Route.
Import ListNotations.
Open Scope R_scope.

(* --- Places in fractions --- *)
(* At a moment; of a trip without duration its start or its goal. *)
Definition qplace (m : trip) (t : Q) (at_end : bool) : point :=
  if qeq (leave m) (arrive m) then (if at_end then goal m else start m)
  else let u := qmul (qsub t (leave m)) (Qinv (qsub (arrive m) (leave m))) in
    (qadd (fst (start m)) (qmul u (qsub (fst (goal m)) (fst (start m)))), qadd (snd (start m)) (qmul u (qsub (snd (goal m)) (snd (start m))))).

Lemma qeq_iff a b : qeq a b = true <-> Q2R a = Q2R b.
Proof.
  split; [apply qeq_R|]. intro h. unfold qeq. apply andb_true_iff. rewrite !qle_iff. lra.
Qed.
Lemma qplace_ok m t e : real (qplace m t e) = at_time m (Q2R t) (if e then 1 else 0).
Proof.
  unfold qplace, at_time. destruct (qeq (leave m) (arrive m)) eqn:h.
  - apply qeq_R in h. destruct (Req_EM_T (Q2R (leave m)) (Q2R (arrive m))); [|contradiction]. destruct e; [now rewrite mix_1|now rewrite mix_0].
  - assert (k : Q2R (leave m) <> Q2R (arrive m)) by (intro k; apply qeq_iff in k; congruence).
    destruct (Req_EM_T (Q2R (leave m)) (Q2R (arrive m))); [contradiction|].
    unfold mix, add, scale, real; cbn [fst snd]. rewrite !Q2R_add, !Q2R_mul, !Q2R_sub.
    rewrite Q2R_inv; [|intro z; apply k; apply Qeq_eqR in z; rewrite Q2R_sub, Q2R_0 in z; lra]. rewrite Q2R_sub.
    assert (Q2R (arrive m) - Q2R (leave m) <> 0) by lra. f_equal; field; assumption.
Qed.

(* Between two moments a body is between its places at these. *)
Definition share (m : trip) (from to : Q) (t s : R) : R := if Req_EM_T (Q2R from) (Q2R to) then s else (t - Q2R from) / (Q2R to - Q2R from).
Lemma at_share m from to t s : Q2R (leave m) <= Q2R from -> Q2R to <= Q2R (arrive m) -> Q2R from <= t <= Q2R to ->
  at_time m t s = mix (share m from to t s) (real (qplace m from false)) (real (qplace m to true)).
Proof.
  intros hl ha ht. rewrite !qplace_ok. unfold at_time, share.
  destruct (Req_EM_T (Q2R (leave m)) (Q2R (arrive m))) as [e|n], (Req_EM_T (Q2R from) (Q2R to)) as [f|f].
  - now rewrite mix_0, mix_1.
  - exfalso. apply f. lra.
  - replace t with (Q2R from) by lra. rewrite f. unfold mix, add, scale; simpl. f_equal; ring.
  - rewrite mix_mix. f_equal. field. lra.
Qed.
Lemma share_ok m from to t s : 0 <= s <= 1 -> Q2R from <= t <= Q2R to -> 0 <= share m from to t s <= 1.
Proof. intros hs ht. unfold share. destruct (Req_EM_T (Q2R from) (Q2R to)); [assumption|]. apply share_bounds; lra. Qed.

(* --- One separation --- *)
(* By how much n parts them if the difference of the places is d. *)
Definition gap_along (n d : point) (p q : part) : option Q :=
  match corners p, corners q with
  | v :: vs, w :: ws => Some (qsub (qadd (pdot n d) (lowest n v vs)) (highest n w ws))
  | _, _ => None
  end.
Definition wide (n : point) (reaches width : Q) (gap : option Q) : bool :=
  match gap with
  | None => false
  | Some g => qlt 0 g && (let m := qadd reaches width in let left := qmul g g in let right := qmul (qmul m m) (pdot n n) in
      if qlt 0 width then qle right left else qlt right left)
  end.
Definition separates (a b : trip) (p q : part) (s : separation) : bool :=
  let n := direction s in let r := qadd (reach p) (reach q) in
  qle 0 (reach p) && qle 0 (reach q) && qle 0 (width s)
  && wide n r (width s) (gap_along n (psub (qplace a (since s) false) (qplace b (since s) false)) p q)
  && wide n r (width s) (gap_along n (psub (qplace a (until s) true) (qplace b (until s) true)) p q).

Lemma gap_ok n d p q g x y : gap_along n d p q = Some g -> hull (corners p) x -> hull (corners q) y ->
  Q2R g <= dot (real n) (sub (add (real d) x) y).
Proof.
  unfold gap_along. intros h hx hy. destruct (corners p) as [|v vs]; [discriminate|]. destruct (corners q) as [|w ws]; [discriminate|].
  injection h as h. subst g. rewrite Q2R_sub, Q2R_add, Q2R_dot, dot_sub, dot_add.
  pose proof (hull_above (real n) _ _ (lowest_ok n vs v) x hx). pose proof (hull_below (real n) _ _ (highest_ok n ws w) y hy). lra.
Qed.
Lemma wide_ok n r width gap : 0 <= Q2R r -> 0 <= Q2R width -> wide n r width gap = true ->
  exists g, gap = Some g /\ 0 < Q2R g /\ Q2R r * Q2R r * dot (real n) (real n) < Q2R g * Q2R g.
Proof.
  intros r0 w0 h. unfold wide in h. destruct gap as [g|]; [|discriminate]. exists g. split; [reflexivity|].
  apply andb_true_iff in h. destruct h as [g0 h]. apply qlt_R in g0. rewrite Q2R_0 in g0. split; [assumption|].
  pose proof (dot_self (real n)) as nn. destruct (qlt 0 width) eqn:e.
  - apply qlt_R in e. apply qle_R in h. rewrite !Q2R_mul, Q2R_dot, Q2R_add in h. rewrite Q2R_0 in e.
    destruct (Rle_lt_or_eq_dec _ _ nn) as [n0|n0]; [|rewrite <- n0, Rmult_0_r; now apply Rmult_lt_0_compat].
    apply Rlt_le_trans with (2 := h). apply Rmult_lt_compat_r; [assumption|]. nra.
  - apply qlt_R in h. rewrite !Q2R_mul, Q2R_dot, Q2R_add in h. apply Rle_lt_trans with (2 := h). apply Rmult_le_compat_r; [assumption|]. nra.
Qed.

Definition strictly_apart (r : R) (x y : vec) := r * r < dot (sub x y) (sub x y).
Lemma far_strict n z r g : 0 < g -> r * r * dot n n < g * g -> g <= dot n z -> r * r < dot z z.
Proof.
  intros g0 h k. assert (k2 : g * g <= dot n z * dot n z) by nra. pose proof (cauchy_schwarz n z). pose proof (dot_self n). pose proof (dot_self z).
  destruct (Rlt_or_le (r * r) (dot z z)); [assumption|]. exfalso. nra.
Qed.

Definition parted_between (a b : trip) (p q : part) (t s : R) := forall x y, hull (corners p) x -> hull (corners q) y ->
  strictly_apart (Q2R (reach p) + Q2R (reach q)) (add (at_time a t s) x) (add (at_time b t s) y).
Lemma separates_ok a b p q s : separates a b p q s = true -> 
  Q2R (leave a) <= Q2R (since s) -> Q2R (until s) <= Q2R (arrive a) -> Q2R (leave b) <= Q2R (since s) -> Q2R (until s) <= Q2R (arrive b) ->
  0 <= Q2R (reach p) /\ 0 <= Q2R (reach q) /\ forall t u, Q2R (since s) <= t <= Q2R (until s) -> 0 <= u <= 1 -> parted_between a b p q t u.
Proof.
  unfold separates. intros h la aa lb ab.
  apply andb_true_iff in h; destruct h as [h k1]. apply andb_true_iff in h; destruct h as [h k0]. apply andb_true_iff in h; destruct h as [h w0].
  apply andb_true_iff in h; destruct h as [p0 q0]. apply qle_R in p0, q0, w0. rewrite Q2R_0 in p0, q0, w0. split; [assumption|]. split; [assumption|].
  assert (r0 : 0 <= Q2R (qadd (reach p) (reach q))) by (rewrite Q2R_add; lra).
  destruct (wide_ok _ _ _ _ r0 w0 k0) as [g [eg [gp gh]]]. destruct (wide_ok _ _ _ _ r0 w0 k1) as [f [ef [fp fh]]]. clear k0 k1.
  rewrite Q2R_add in gh, fh. intros t u ht hu x y hx hy.
  assert (kg := gap_ok _ _ _ _ _ _ _ eg hx hy). assert (kf := gap_ok _ _ _ _ _ _ _ ef hx hy). rewrite real_sub in kg, kf.
  unfold strictly_apart. rewrite (at_share a (since s) (until s) t u), (at_share b (since s) (until s) t u) by assumption.
  change (share b (since s) (until s) t u) with (share a (since s) (until s) t u).
  assert (hl := share_ok a (since s) (until s) t u hu ht). set (l := share a (since s) (until s) t u) in *.
  set (a0 := real (qplace a (since s) false)) in *. set (a1 := real (qplace a (until s) true)) in *.
  set (b0 := real (qplace b (since s) false)) in *. set (b1 := real (qplace b (until s) true)) in *. set (n := real (direction s)) in *.
  assert (e : dot n (sub (add (mix l a0 a1) x) (add (mix l b0 b1) y)) =
    (1 - l) * dot n (sub (add (sub a0 b0) x) y) + l * dot n (sub (add (sub a1 b1) x) y)) by (unfold dot, sub, add, mix, scale; simpl; ring).
  destruct (Rle_or_lt (Q2R g) (Q2R f)).
  - apply (far_strict n _ _ (Q2R g)); [assumption|assumption|rewrite e; nra].
  - apply (far_strict n _ _ (Q2R f)); [assumption|assumption|rewrite e; nra].
Qed.

(* --- A list of them: of each two parts in turn, without a gap --- *)
Fixpoint taken (fits : separation -> bool) (from to : Q) (l : list separation) : option (list separation) :=
  match l with
  | [] => None
  | s :: r => if fits s && qeq (since s) from && qle (since s) (until s) && qle (until s) to
      then if qeq (until s) to then Some r else taken fits (until s) to r else None
  end.
Lemma taken_ok fits to l : forall from rest, taken fits from to l = Some rest -> forall t, Q2R from <= t <= Q2R to ->
  exists s, fits s = true /\ Q2R from <= Q2R (since s) /\ Q2R (until s) <= Q2R to /\ Q2R (since s) <= t <= Q2R (until s).
Proof.
  induction l as [|s r ih]; intros from rest h t ht; [discriminate|]. simpl in h.
  destruct (fits s) eqn:fs; [|discriminate]. destruct (qeq (since s) from) eqn:e; [|discriminate].
  destruct (qle (since s) (until s)) eqn:o; [|discriminate]. destruct (qle (until s) to) eqn:u; [|discriminate]. simpl in h.
  apply qeq_R in e. apply qle_R in o, u. destruct (Rle_or_lt t (Q2R (until s))) as [l|l]; [exists s; repeat split; auto; lra|].
  destruct (qeq (until s) to) eqn:d; [apply qeq_R in d; exfalso; lra|].
  destruct (ih _ _ h t) as [s' [h1 [h2 [h3 h4]]]]; [lra|]. exists s'. repeat split; auto; lra.
Qed.

Definition numbered {A} (l : list A) : list (nat * A) := combine (seq 0 (length l)) l.
Definition pairs (a b : trip) : list ((nat * part) * (nat * part)) := list_prod (numbered (parts a)) (numbered (parts b)).
Fixpoint all_taken (a b : trip) (from to : Q) (ps : list ((nat * part) * (nat * part))) (l : list separation) : bool :=
  match ps with
  | [] => match l with [] => true | _ => false end
  | ((i, p), (j, q)) :: ps =>
      match taken (fun s => Nat.eqb (part_no s) i && Nat.eqb (other_no s) j && separates a b p q s) from to l with
      | Some rest => all_taken a b from to ps rest
      | None => false
      end
  end.
Definition sweep (a b : trip) (l : list separation) : bool :=
  let from := qmax (leave a) (leave b) in let to := qmin (arrive a) (arrive b) in
  if qlt to from then match l with [] => true | _ => false end else all_taken a b from to (pairs a b) l.

Lemma in_numbered {A} (l : list A) x : In x l -> exists i, In (i, x) (numbered l).
Proof.
  unfold numbered. generalize 0%nat. induction l as [|y l ih]; intros k h; [destruct h|]. simpl.
  destruct h as [e|h]; [subst; exists k; now left|]. destruct (ih (S k) h) as [i hi]. exists i. now right.
Qed.
Lemma all_taken_ok a b from to ps : forall l, all_taken a b from to ps l = true -> forall i p j q, In ((i, p), (j, q)) ps ->
  exists l rest, taken (fun s => Nat.eqb (part_no s) i && Nat.eqb (other_no s) j && separates a b p q s) from to l = Some rest.
Proof.
  induction ps as [|[[i0 p0] [j0 q0]] ps ih]; intros l h i p j q hin; [destruct hin|]. simpl in h.
  destruct (taken _ from to l) as [rest|] eqn:e; [|discriminate]. destruct hin as [eq|hin]; [injection eq as; subst; now exists l, rest|].
  now apply (ih rest).
Qed.

Lemma sweep_parts a b l : sweep a b l = true -> forall t s p q, under_way a t -> under_way b t -> 0 <= s <= 1 -> In p (parts a) -> In q (parts b) ->
  0 <= Q2R (reach p) /\ 0 <= Q2R (reach q) /\ parted_between a b p q t s.
Proof.
  unfold sweep. intros h t u p q ua ub hu hp hq. unfold under_way in ua, ub.
  set (from := qmax (leave a) (leave b)) in *. set (to := qmin (arrive a) (arrive b)) in *.
  assert (ef : Q2R (leave a) <= Q2R from /\ Q2R (leave b) <= Q2R from /\ (Q2R from <= t)).
  { unfold from. rewrite Q2R_max. repeat split; [apply Rmax_l|apply Rmax_r|]. apply Rmax_lub; lra. }
  assert (et : Q2R to <= Q2R (arrive a) /\ Q2R to <= Q2R (arrive b) /\ (t <= Q2R to)).
  { unfold to. rewrite Q2R_min. repeat split; [apply Rmin_l|apply Rmin_r|]. apply Rmin_glb; lra. }
  destruct (qlt to from) eqn:e; [apply qlt_R in e; exfalso; lra|].
  destruct (in_numbered _ _ hp) as [i hi]. destruct (in_numbered _ _ hq) as [j hj].
  destruct (all_taken_ok _ _ _ _ _ _ h i p j q) as [l' [rest k]]; [now apply in_prod|].
  destruct (taken_ok _ _ _ _ _ k t) as [s [hs [s1 [s2 s3]]]]; [lra|].
  apply andb_true_iff in hs. destruct hs as [_ hs]. apply separates_ok in hs; [|lra|lra|lra|lra].
  destruct hs as [p0 [q0 hs]]. split; [assumption|]. split; [assumption|]. now apply hs.
Qed.

Lemma no_common (r q : R) u v z : 0 <= r -> 0 <= q -> strictly_apart (r + q) u v ->
  dot (sub z u) (sub z u) <= r * r -> dot (sub z v) (sub z v) <= q * q -> False.
Proof.
  unfold strictly_apart. intros r0 q0 h hu hv. assert (k := bounded_dot (sub u z) (sub z v) r q r0 q0).
  assert (e : dot (sub u z) (sub u z) = dot (sub z u) (sub z u)) by (unfold dot, sub; simpl; ring). rewrite e in k. specialize (k hu hv).
  assert (f : dot (sub u v) (sub u v) = dot (sub z u) (sub z u) + 2 * dot (sub u z) (sub z v) + dot (sub z v) (sub z v)) by (unfold dot, sub; simpl; ring).
  rewrite f in h. nra.
Qed.

Theorem sweep_sound a b l : sweep a b l = true -> never_meet a b.
Proof.
  intros h t s x ua ub hs [p [y [hp [hy dy]]]] [q [z [hq [hz dz]]]].
  destruct (sweep_parts _ _ _ h t s p q ua ub hs hp hq) as [p0 [q0 k]]. apply (no_common _ _ _ _ x p0 q0 (k y z hy hz) dy dz).
Qed.

(* --- Past an obstacle: its edges are bodies at rest, and no part begins inside --- *)
Definition at_rest (m : trip) (es : list edge) : trip :=
  {| leave := leave m; arrive := arrive m; start := (0, 0)%Q; goal := (0, 0)%Q; parts := map (fun e => {| corners := [fst e; snd e]; reach := 0%Q |}) es |}.
Definition padd (a b : point) : point := (qadd (fst a) (fst b), qadd (snd a) (snd b)).
Definition begins_outside (m : trip) (o : obstacle) (es : list edge) : bool :=
  match o with
  | Wall _ => true
  | Solid _ => forallb (fun p => match corners p with [] => false | v :: _ => negb (qodd es (padd (start m) v)) end) (parts m)
  end.
Definition sweep_past (m : trip) (o : obstacle) (l : list separation) : bool :=
  let es := edges_of o in sweep m (at_rest m es) l && begins_outside m o es.

Lemma rest_place m es t s : at_time (at_rest m es) t s = (0, 0).
Proof. unfold at_time, at_rest, mix, add, scale, real; simpl. rewrite Q2R_0. f_equal; ring. Qed.

Lemma past_edges m o l : sweep m (at_rest m (edges_of o)) l = true -> forall t s x e, under_way m t -> 0 <= s <= 1 -> covers m t s x -> In e (edges_of o) -> ~ on e x.
Proof.
  intros h t s x e ut hs c he ox. apply (sweep_sound _ _ _ h t s x ut ut hs c).
  exists {| corners := [fst e; snd e]; reach := 0%Q |}, x. split; [simpl; apply in_map_iff; now exists e|]. split; [exact ox|].
  rewrite rest_place. simpl. rewrite Q2R_0. unfold dot, sub, add; simpl. nra.
Qed.

Lemma straight_even es x y : closed es -> (forall u, 0 <= u <= 1 -> off es (mix u x y)) -> odd es x = false -> odd es y = false.
Proof.
  intros c h k. rewrite <- (mix_0 x y) in k. rewrite <- (mix_1 x y). rewrite <- k. symmetry.
  apply (odd_path es (fun t => mix t x y) c (mix_continuous _ _) h).
Qed.

Theorem sweep_past_sound m o l : sweep_past m o l = true -> stays_out m o.
Proof.
  unfold sweep_past. intro h. apply andb_true_iff in h. destruct h as [h b]. assert (k := past_edges m o l h).
  intros t s x ut hs c. split; [|intros e he; now apply (k t s x e)].
  intros o' [eo|[]]. subst o'. destruct o as [w|rs]; [exact I|]. set (es := edges_of (Solid rs)) in *.
  assert (cl : closed es) by apply rings_closed. destruct c as [p [y [hp [hy dy]]]].
  simpl in b. rewrite forallb_forall in b. specialize (b p hp). destruct (corners p) as [|v vs] eqn:ev; [discriminate|].
  apply negb_true_iff in b. rewrite qodd_ok in b.
  assert (ev' : real (padd (start m) v) = add (real (start m)) (real v)) by (unfold padd, add, real; simpl; now rewrite !Q2R_add). rewrite ev' in b.
  assert (hv : hull (corners p) (real v)) by (rewrite ev; apply corner; now left). rewrite <- ev in hy.
  assert (r0 : 0 <= Q2R (reach p) * Q2R (reach p)) by nra.
  assert (here : forall t s z, under_way m t -> 0 <= s <= 1 -> hull (corners p) z -> off es (add (at_time m t s) z)).
  { intros t' s' z ut' hs' hz e he. apply (k t' s' _ e ut' hs'); [|exact he]. exists p, z. split; [assumption|]. split; [assumption|]. cbv zeta.
    replace (dot (sub (add (at_time m t' s') z) (add (at_time m t' s') z)) (sub (add (at_time m t' s') z) (add (at_time m t' s') z))) with 0; [assumption|].
    unfold dot, sub, add; simpl; ring. }
  (* Along the trip, within the part, and out to its reach. *)
  assert (b1 : odd es (add (at_time m t s) (real v)) = false).
  { apply (straight_even es (add (real (start m)) (real v))); [assumption| |exact b].
    intros u hu. unfold under_way in ut. destruct (Req_EM_T (Q2R (leave m)) (Q2R (arrive m))) as [e|n].
    - replace (mix u (add (real (start m)) (real v)) (add (at_time m t s) (real v))) with (add (at_time m t (u * s)) (real v)).
      + apply here; [assumption|nra|assumption].
      + unfold at_time. destruct (Req_EM_T (Q2R (leave m)) (Q2R (arrive m))); [|contradiction]. unfold mix, add, scale; simpl. f_equal; ring.
    - replace (mix u (add (real (start m)) (real v)) (add (at_time m t s) (real v))) with (add (at_time m (Q2R (leave m) + u * (t - Q2R (leave m))) s) (real v)).
      + apply here; [|assumption|assumption]. unfold under_way. split; [nra|]. assert (u * (t - Q2R (leave m)) <= 1 * (t - Q2R (leave m))) by (apply Rmult_le_compat_r; lra). lra.
      + unfold at_time. destruct (Req_EM_T (Q2R (leave m)) (Q2R (arrive m))); [contradiction|]. unfold mix, add, scale; simpl. f_equal; field; lra. }
  assert (b2 : odd es (add (at_time m t s) y) = false).
  { apply (straight_even es (add (at_time m t s) (real v))); [assumption| |exact b1]. intros u hu.
    replace (mix u (add (at_time m t s) (real v)) (add (at_time m t s) y)) with (add (at_time m t s) (mix u (real v) y))
      by (unfold mix, add, scale; simpl; f_equal; ring).
    apply here; [assumption|assumption|now apply chord]. }
  apply (straight_even es (add (at_time m t s) y)); [assumption| |exact b2]. intros u hu e he.
  apply (k t s _ e ut hs); [|exact he]. exists p, y. split; [assumption|]. split; [assumption|]. cbv zeta. cbv zeta in dy.
  set (c := add (at_time m t s) y) in *.
  replace (dot (sub (mix u c x) c) (sub (mix u c x) c)) with (u * u * dot (sub x c) (sub x c)) by (unfold dot, sub, mix, add, scale; simpl; ring).
  pose proof (dot_self (sub x c)). assert (u * u <= 1) by nra. nra.
Qed.
